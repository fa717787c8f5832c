// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "colonnade/base/error.hpp"
#include "job_test.hpp"

namespace colonnade {
namespace {

using Status = JobResult::Status;
class Interruption : public testing::JobTest {
 protected:
  /// The number a job wrote into `name`, once it is there.
  pid_t pidIn(const char* name) const {
    for (int i = 0; i < 200; ++i, ::usleep(50'000)) {
      const std::string text = contentOf(folder_ / name);
      if (text.ends_with("\n")) return std::stoi(text);
    }
    throw Error(std::string(name) + " was never written");
  }
};

TEST_F(Interruption, ForwardsToTheChildrenAndBeginsNoFurtherJob) {
  const std::vector<Job> jobs{
      shell("graceful", "trap 'echo bye; exit 130' INT; touch one; while :; do sleep 0.05; done"),
      shell("plain", "touch two; exec sleep 60"),
      shell("interrupter",
            "until test -e one && test -e two; do sleep 0.05; done; exec kill -INT $PPID"),
      shell("never", "touch begun")};
  JobRunner runner({.parallel = 3, .grace_s = 600.0});
  const auto results = runner.run(jobs);
  EXPECT_TRUE(runner.interrupted());
  EXPECT_EQ(Status::kInterrupted, results[0].status);
  EXPECT_EQ(130, results[0].exit_code);
  EXPECT_EQ("bye\n", contentOf(jobs[0].log));
  EXPECT_EQ(Status::kInterrupted, results[1].status);
  EXPECT_EQ(SIGINT, results[1].signal);
  EXPECT_EQ(Status::kNotStarted, results[3].status);
  EXPECT_EQ("never", results[3].name);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "begun"));
  // The next jobs of this process are not affected.
  EXPECT_TRUE(runner.run({shell("later", "exit 0")})[0].ok());
  EXPECT_FALSE(runner.interrupted());
}

TEST_F(Interruption, KillsWhoDoesNotListenAfterTheGrace) {
  const Job deaf = shell("deaf", "trap '' INT TERM; kill -TERM $PPID; while :; do sleep 0.1; done");
  const auto results = JobRunner({.parallel = 1, .grace_s = 0.3}).run({deaf});
  EXPECT_EQ(Status::kInterrupted, results[0].status);
  EXPECT_EQ(SIGKILL, results[0].signal);
}

TEST_F(Interruption, KillsAtOnceAtTheSecondSignal) {
  const Job deaf = shell("deaf",
                         "trap '' INT TERM; kill -INT $PPID; sleep 0.3; kill -INT $PPID;"
                         "while :; do sleep 0.1; done");
  const auto results = JobRunner({.parallel = 1, .grace_s = 3600.0}).run({deaf});
  EXPECT_EQ(SIGKILL, results[0].signal);
}

TEST_F(Interruption, RestoresTheHandlersOfItsCaller) {
  static volatile sig_atomic_t caught = 0;
  const auto former = ::signal(SIGINT, [](int) { caught = 1; });
  JobRunner().run({shell("quick", "exit 0")});
  ::raise(SIGINT);
  EXPECT_EQ(1, caught);
  ::signal(SIGINT, former);
}

TEST_F(Interruption, LeavesNoOrphanWhenKilled) {
  ASSERT_EQ(0, ::prctl(PR_SET_CHILD_SUBREAPER, 1));  // orphans come to this test
  const pid_t parent = ::fork();
  if (parent == 0) {
    JobRunner().run({shell("endless", "echo $$ > pid; exec sleep 60")});
    ::_exit(0);
  }
  const pid_t child = pidIn("pid");
  ASSERT_EQ(0, ::kill(child, 0));
  ::kill(parent, SIGKILL);
  ASSERT_EQ(parent, ::waitpid(parent, nullptr, 0));
  int status = 0;
  ASSERT_EQ(child, ::waitpid(child, &status, 0));  // would last a minute otherwise
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(SIGKILL, WTERMSIG(status));
  ::prctl(PR_SET_CHILD_SUBREAPER, 0);
}

}  // namespace
}  // namespace colonnade
