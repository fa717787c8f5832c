// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "signal_pipe.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "colonnade/base/error.hpp"

namespace colonnade {
namespace {

volatile std::sig_atomic_t pipe_to_write = -1;

extern "C" void passOn(int signal) {
  const int error = errno;
  const auto byte = static_cast<unsigned char>(signal);
  [[maybe_unused]] const auto written = ::write(pipe_to_write, &byte, 1);  // full: enough is known
  errno = error;
}

}  // namespace

SignalPipe::SignalPipe() {
  if (pipe_to_write != -1) throw Error("a second JobRunner runs in this process");
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC | O_NONBLOCK) != 0) {
    throw Error(std::string("no pipe for signals: ") + std::strerror(errno));
  }
  read_end_ = ends[0];
  write_end_ = ends[1];
  pipe_to_write = write_end_;
  struct sigaction action {};
  action.sa_handler = passOn;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    ::sigaction(kSignals[i], nullptr, &former_[i]);
    const bool nohup = kSignals[i] == SIGHUP && former_[i].sa_handler == SIG_IGN;
    if (!nohup) ::sigaction(kSignals[i], &action, nullptr);
  }
}

SignalPipe::~SignalPipe() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) ::sigaction(kSignals[i], &former_[i], nullptr);
  pipe_to_write = -1;
  ::close(read_end_);
  ::close(write_end_);
}

std::vector<int> SignalPipe::wait(int timeout_ms) {
  pollfd readable{read_end_, POLLIN, 0};
  ::poll(&readable, 1, timeout_ms);  // a signal may end it early: the pipe tells
  std::vector<int> signals;
  unsigned char bytes[64];
  for (ssize_t count = 0; (count = ::read(read_end_, bytes, sizeof bytes)) > 0;)
    signals.insert(signals.end(), bytes, bytes + count);
  return signals;
}

}  // namespace colonnade
