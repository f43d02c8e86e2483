#pragma once

#include <csignal>

namespace lidar_panoptic_clustering
{
namespace detail
{
inline volatile std::sig_atomic_t received_signal = 0;

inline void receiveSignal(int signal)
{
  received_signal = signal;
  std::signal(signal, SIG_DFL);  // a second one ends the program at once
}
}  // namespace detail

/// From now on SIGINT (Ctrl-C) and SIGTERM are only noted, each once.
inline void noteInterrupts()
{
  std::signal(SIGINT, detail::receiveSignal);
  std::signal(SIGTERM, detail::receiveSignal);
}

/// The signal noted; 0 for none.
inline int interrupted()
{
  return detail::received_signal;
}
}  // namespace lidar_panoptic_clustering
