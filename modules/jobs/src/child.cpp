// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "child.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

#include "colonnade/base/error.hpp"

namespace colonnade {
namespace {

/// Closed when it goes out of scope.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { reset(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return number_; }
  void reset() {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }

 private:
  int number_;
};

/// A file of the child's words; an empty path gives /dev/null.
int openToWrite(const std::filesystem::path& path) {
  if (!path.parent_path().empty()) {
    std::error_code ignored;  // the open below says it better
    std::filesystem::create_directories(path.parent_path(), ignored);
  }
  const char* name = path.empty() ? "/dev/null" : path.c_str();
  const int number = ::open(name, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (number < 0) throw Error(path.string() + ": cannot be written: " + std::strerror(errno));
  return number;
}

/// The child's side of fork(): only calls that are safe there. Never returns.
[[noreturn]] void become(const char* program, char* const* arguments, pid_t parent, int input,
                         int output, int log, int report) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(127);  // it died before the line above
  struct sigaction action {};
  action.sa_handler = SIG_DFL;
  for (const int signal : {SIGINT, SIGTERM, SIGCHLD, SIGPIPE})
    ::sigaction(signal, &action, nullptr);
  sigset_t none;
  sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  if (::dup2(input, STDIN_FILENO) >= 0 && ::dup2(output, STDOUT_FILENO) >= 0 &&
      ::dup2(log, STDERR_FILENO) >= 0) {
    ::execvp(program, arguments);
  }
  const int error = errno;
  [[maybe_unused]] const auto written = ::write(report, &error, sizeof error);
  ::_exit(127);
}

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

Child::Child(const Job& job) {
  result_.name = job.name;
  if (job.timeout_s > 0.0) {
    timeout_ = began_ + std::chrono::duration_cast<Clock::duration>(
                            std::chrono::duration<double>(job.timeout_s));
  }
  const std::string program = job.program.empty() ? "/proc/self/exe" : job.program.string();
  std::string title = job.program.empty() ? "colonnade" : program;
  std::vector<std::string> words = job.arguments;
  std::vector<char*> arguments{title.data()};
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);

  const Descriptor input(::open("/dev/null", O_RDONLY | O_CLOEXEC));
  const Descriptor log(openToWrite(job.log));
  const Descriptor output(job.output.empty() ? ::dup(log.get()) : openToWrite(job.output));
  ::fcntl(output.get(), F_SETFD, FD_CLOEXEC);
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) {
    throw Error(std::string("no pipe for a child: ") + std::strerror(errno));
  }
  const Descriptor read_end(ends[0]);
  Descriptor write_end(ends[1]);
  const pid_t parent = ::getpid();
  pid_ = ::fork();
  if (pid_ < 0) {
    result_.reason = std::string("fork: ") + std::strerror(errno);
    return;
  }
  if (pid_ == 0) {
    become(program.c_str(), arguments.data(), parent, input.get(), output.get(), log.get(),
           write_end.get());
  }
  ::setpgid(pid_, pid_);  // here too: whoever comes first
  write_end.reset();
  int error = 0;
  ssize_t count = 0;
  while ((count = ::read(read_end.get(), &error, sizeof error)) < 0 && errno == EINTR) {
  }
  if (count == sizeof error) {  // exec failed
    ::waitpid(pid_, nullptr, 0);
    pid_ = -1;
    result_.reason = program + ": " + std::strerror(error);
  }
}

Child::Child(Child&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)),
      result_(std::move(other.result_)),
      began_(other.began_),
      timeout_(other.timeout_),
      kill_(other.kill_),
      stopped_as_(other.stopped_as_) {}

Child::~Child() {
  if (pid_ <= 0) return;
  signal(SIGKILL);
  while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

void Child::signal(int number) const {
  if (pid_ > 0 && ::kill(-pid_, number) != 0) ::kill(pid_, number);
}

void Child::stop(int number, JobResult::Status why, Clock::time_point deadline) {
  if (!stopped_as_) stopped_as_ = why;
  timeout_.reset();
  kill_ = deadline;
  signal(number);
}

void Child::enforce(double grace_s) {
  const auto now = Clock::now();
  if (kill_ && now >= *kill_) {
    signal(SIGKILL);
    kill_.reset();
  } else if (timeout_ && now >= *timeout_) {
    const auto grace = std::chrono::duration<double>(grace_s);
    stop(SIGTERM, JobResult::Status::kTimedOut,
         now + std::chrono::duration_cast<Clock::duration>(grace));
  }
}

std::optional<Child::Clock::time_point> Child::due() const { return kill_ ? kill_ : timeout_; }

std::optional<JobResult> Child::result() {
  if (pid_ < 0) return result_;
  siginfo_t info{};
  if (::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
      info.si_pid == 0) {
    return std::nullopt;
  }
  signal(SIGKILL);  // what it left in its group, while its id is still its own
  int status = 0;
  rusage usage{};
  const bool reaped = ::wait4(pid_, &status, 0, &usage) == pid_;
  pid_ = -1;
  if (!reaped) {
    result_.reason = "reaped by another part of this process";
    return result_;
  }
  using Status = JobResult::Status;
  result_.wall_s = std::chrono::duration<double>(Clock::now() - began_).count();
  result_.cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  result_.peak_rss_mb = static_cast<double>(usage.ru_maxrss) / 1024.0;
  result_.reason.clear();
  if (WIFSIGNALED(status)) {
    result_.status = Status::kSignalled;
    result_.signal = WTERMSIG(status);
  } else {
    result_.status = Status::kExited;
    result_.exit_code = WEXITSTATUS(status);
  }
  if (stopped_as_ && !result_.ok()) result_.status = *stopped_as_;
  return result_;
}

}  // namespace colonnade
