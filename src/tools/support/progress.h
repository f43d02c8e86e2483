#pragma once

#include "core/plain_numbers.h"
#include "core/printable.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <mutex>
#include <string>

namespace lidar_panoptic_clustering
{
/// Progress of a long run on stderr: on a terminal one bar with rate and time left, else a plain line every ten
/// percent. May be stepped from several threads. Without a file to print to it prints nothing.
class Progress
{
public:
  Progress(std::string what, std::size_t total, bool terminal = isatty(STDERR_FILENO) == 1, std::FILE* out = stderr)
      : what_(std::move(what)), total_(total), terminal_(terminal), out_(out)
  {
  }
  ~Progress() { finish(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void step()
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++done_;
    if (out_ == nullptr) return;
    const auto now = Clock::now();
    if (terminal_)
    {
      if (now - drawn_ < std::chrono::milliseconds(100) && done_ < total_) return;
      drawn_ = now;
      drawBar();
    }
    else if (10 * done_ / total_ != 10 * (done_ - 1) / total_)
    {
      std::fprintf(out_, "%s: %s\n", what_.c_str(), summary().c_str());
    }
  }

  /// Prints a line of its own, without tearing the bar.
  void note(const std::string& line)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (out_ == nullptr) return;
    clearBar();
    std::fprintf(out_, "%s\n", printable(line).c_str());
  }

  /// Ends the bar's line; called by the destructor too.
  void finish()
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (out_ == nullptr) return;
    clearBar();
    std::fflush(out_);
  }

private:
  using Clock = std::chrono::steady_clock;

  void clearBar()
  {
    if (bar_shown_) std::fputs("\r\x1b[K", out_);
    bar_shown_ = false;
  }

  void drawBar()
  {
    constexpr std::size_t kWidth = 30;
    const std::size_t filled = std::min(kWidth, kWidth * done_ / std::max<std::size_t>(total_, 1));
    const std::string bar = std::string(filled, '#') + std::string(kWidth - filled, ' ');
    std::fprintf(out_, "\r%s [%s] %s\x1b[K", what_.c_str(), bar.c_str(), summary().c_str());
    std::fflush(out_);
    bar_shown_ = true;
  }

  std::string summary() const
  {
    const double seconds = std::max(std::chrono::duration<double>(Clock::now() - begin_).count(), 1e-6);
    const double rate = static_cast<double>(done_) / seconds;
    const auto left = static_cast<long>(static_cast<double>(total_ - std::min(done_, total_)) / rate + 0.5);
    const PlainNumbers plain;
    char text[128];
    std::snprintf(text, sizeof text, "%zu/%zu, %.1f a second, %ld:%02ld left", done_, total_, rate, left / 60,
                  left % 60);
    return text;
  }

  std::string what_;
  std::size_t total_, done_ = 0;
  bool terminal_, bar_shown_ = false;
  std::FILE* out_;
  std::mutex mutex_;
  Clock::time_point begin_ = Clock::now(), drawn_;
};
}  // namespace lidar_panoptic_clustering
