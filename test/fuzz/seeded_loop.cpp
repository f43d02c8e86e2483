// What runs a fuzzer where there is no libFuzzer: its corpus as it is, then changed copies, the same at each run.
//
//   NAME [--seconds N] [--seed N] FILE_OR_FOLDER ..
//
// An input that ends the program is left in the working directory as crash-NAME.
#include "fuzz_input.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

extern "C" void __sanitizer_set_death_callback(void (*callback)()) __attribute__((weak));

namespace
{
namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

Bytes current;
std::string crash_file;

void saveCurrent()
{
  const int file = ::open(crash_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) return;
  if (::write(file, current.data(), current.size()) < 0) std::perror("crash file");
  ::close(file);
}

extern "C" void dieOf(int signal)
{
  saveCurrent();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void run(const Bytes& input)
{
  current = input;
  LLVMFuzzerTestOneInput(current.data(), current.size());
}

class Mutator
{
public:
  Mutator(unsigned seed, const std::vector<Bytes>& corpus) : random_(seed), corpus_(corpus) {}

  Bytes next()
  {
    Bytes input = corpus_[upTo(corpus_.size())];
    for (std::size_t n = 1 + upTo(4); n > 0; --n) change(input);
    return input;
  }

private:
  static constexpr std::size_t kLongest = 1U << 14U;

  std::size_t upTo(std::size_t n) { return n == 0 ? 0 : random_() % n; }

  void change(Bytes& input)
  {
    static const std::vector<std::string> kPieces = {"-1",
                                                     "0",
                                                     "1e-30",
                                                     "1e30",
                                                     ".nan",
                                                     ".inf",
                                                     "99999999999999999999",
                                                     "4294967295",
                                                     "[",
                                                     "]",
                                                     "{",
                                                     "}",
                                                     ": ",
                                                     "- ",
                                                     "\n",
                                                     "\"",
                                                     "\\u001b",
                                                     "null",
                                                     std::string("\0\0\0\0", 4),
                                                     std::string("\xFF\xFF\xFF\xFF", 4),
                                                     std::string("\0\0\xC0\x7F", 4),
                                                     std::string("\0\0\x80\x7F", 4),
                                                     std::string("\0\0\x80\xFF", 4)};
    const std::size_t at = upTo(input.size() + 1);
    const auto place = input.begin() + static_cast<std::ptrdiff_t>(at);
    switch (upTo(7))
    {
      case 0:
        if (at < input.size()) input[at] = static_cast<std::uint8_t>(input[at] ^ (1U << upTo(8)));
        break;
      case 1:
        if (at < input.size()) input[at] = static_cast<std::uint8_t>(random_());
        break;
      case 2:
      {
        const std::string& piece = kPieces[upTo(kPieces.size())];
        input.insert(place, piece.begin(), piece.end());
        break;
      }
      case 3:
        input.erase(place, place + static_cast<std::ptrdiff_t>(upTo(std::min<std::size_t>(64, input.size() - at) + 1)));
        break;
      case 4:
        for (std::size_t i = at; i < std::min(input.size(), at + 4); ++i)
          input[i] = static_cast<std::uint8_t>(random_());
        break;
      case 5:  // a piece of another one
      {
        const Bytes& other = corpus_[upTo(corpus_.size())];
        const std::size_t from = upTo(other.size()), count = upTo(std::min<std::size_t>(256, other.size() - from) + 1);
        const auto begin = other.begin() + static_cast<std::ptrdiff_t>(from);
        input.insert(place, begin, begin + static_cast<std::ptrdiff_t>(count));
        break;
      }
      default:
        input.resize(upTo(3) == 0 ? at : std::min(kLongest, 2 * input.size() + 1));
    }
    if (input.size() > kLongest) input.resize(kLongest);
  }

  std::mt19937 random_;
  const std::vector<Bytes>& corpus_;
};

Bytes read(const fs::path& path)
{
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}
}  // namespace

int main(int argc, char** argv)
{
  crash_file = "crash-" + fs::path(argv[0]).filename().string();
  double seconds = 10.0;
  unsigned seed = 1;
  std::vector<fs::path> files;
  for (int i = 1; i < argc; ++i)
  {
    const std::string word = argv[i];
    if (word == "--seconds" && i + 1 < argc)
      seconds = std::atof(argv[++i]);
    else if (word == "--seed" && i + 1 < argc)
      seed = static_cast<unsigned>(std::atoi(argv[++i]));
    else if (fs::is_directory(word))
      std::copy(fs::directory_iterator(word), fs::directory_iterator(), std::back_inserter(files));
    else
      files.emplace_back(word);
  }
  std::sort(files.begin(), files.end());
  for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL}) std::signal(signal, dieOf);
  if (__sanitizer_set_death_callback != nullptr) __sanitizer_set_death_callback(saveCurrent);

  std::vector<Bytes> corpus = {{}};
  for (const fs::path& file : files) corpus.push_back(read(file));
  for (const Bytes& input : corpus) run(input);
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  Mutator mutator(seed, corpus);
  std::size_t runs = 0;
  for (; std::chrono::steady_clock::now() < end; ++runs) run(mutator.next());
  std::cout << corpus.size() - 1 << " inputs of the corpus and " << runs << " changed ones, seed " << seed << "\n";
  return files.empty() ? EXIT_FAILURE : EXIT_SUCCESS;  // without a corpus it looks at next to nothing
}
