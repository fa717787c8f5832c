// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/jobs/job_runner.hpp"

#include <gmock/gmock.h>

#include "colonnade/base/error.hpp"
#include "job_test.hpp"

namespace colonnade {
namespace {

using Status = JobResult::Status;
class JobRunnerTest : public testing::JobTest {};

TEST_F(JobRunnerTest, ReportsExitCodesInTheOrderOfTheJobs) {
  std::vector<Job> jobs;
  for (int i = 0; i < 8; ++i) {
    // The first takes longest, so that they end in another order.
    jobs.push_back(shell("job" + std::to_string(i),
                         "sleep 0." + std::to_string(8 - i) + "; exit " + std::to_string(i)));
  }
  const auto results = JobRunner({.parallel = 8}).run(jobs);
  ASSERT_EQ(8u, results.size());
  for (int i = 0; i < 8; ++i) {
    const JobResult& result = results[static_cast<std::size_t>(i)];
    EXPECT_EQ("job" + std::to_string(i), result.name);
    EXPECT_EQ(Status::kExited, result.status);
    EXPECT_EQ(i, result.exit_code);
    EXPECT_EQ(i == 0, result.ok());
    EXPECT_EQ(i == 0 ? "done" : "exit " + std::to_string(i), result.text());
    EXPECT_GT(result.wall_s, 0.05);
    EXPECT_GT(result.peak_rss_mb, 0.1);
  }
}

TEST_F(JobRunnerTest, KeepsWhatAJobSays) {
  Job together = shell("together", "echo one; echo two >&2");
  Job apart = shell("apart", "echo one; echo two >&2; echo");
  apart.log = folder_ / "new/folder/apart.log";
  apart.output = folder_ / "apart.out";
  JobRunner().run({together, apart});
  EXPECT_EQ("one\ntwo\n", contentOf(together.log));
  EXPECT_EQ("one\n\n", contentOf(apart.output));
  EXPECT_EQ("two\n", contentOf(apart.log));
  EXPECT_EQ("two", lastLineOf(together.log));
  EXPECT_EQ("one", lastLineOf(apart.output));
  EXPECT_EQ("", lastLineOf(folder_ / "absent"));
}

TEST_F(JobRunnerTest, PassesArgumentsAsTheyAre) {
  Job job = shell("arguments", "");
  job.arguments = {"-c", "printf '%s|' \"$@\"", "sh", "a b", "$HOME; exit 7", "'", "", "*"};
  ASSERT_TRUE(JobRunner().run({job})[0].ok());
  EXPECT_EQ("a b|$HOME; exit 7|'||*|", contentOf(job.log));
}

TEST_F(JobRunnerTest, NamesTheSignalOfACrash) {
  const auto results = JobRunner().run({shell("crash", "kill -SEGV $$"), shell("after", "exit 0")});
  EXPECT_EQ(Status::kSignalled, results[0].status);
  EXPECT_EQ(SIGSEGV, results[0].signal);
  EXPECT_EQ("killed by SIGSEGV (Segmentation fault)", results[0].text());
  EXPECT_TRUE(results[1].ok());
}

TEST_F(JobRunnerTest, StopsWhatTakesTooLong) {
  Job polite = shell("polite", "sleep 60");
  Job deaf = shell("deaf", "trap '' TERM; while :; do sleep 1; done");
  Job quick = shell("quick", "exit 0");
  polite.timeout_s = deaf.timeout_s = 0.2;
  quick.timeout_s = 60.0;
  const auto results = JobRunner({.parallel = 3, .grace_s = 0.3}).run({polite, deaf, quick});
  EXPECT_EQ(Status::kTimedOut, results[0].status);
  EXPECT_EQ(Status::kTimedOut, results[1].status);
  EXPECT_THAT(results[1].text(), ::testing::HasSubstr("too long"));
  EXPECT_TRUE(results[2].ok());
  for (const auto& result : results) EXPECT_LT(result.wall_s, 20.0);
}

TEST_F(JobRunnerTest, NeverRunsMoreThanAllowed) {
  std::vector<Job> jobs;
  for (int i = 0; i < 9; ++i) {
    const std::string mine = "running." + std::to_string(i);
    jobs.push_back(
        shell("job" + std::to_string(i),
              "touch " + mine + "; ls running.* 2>/dev/null | wc -l; " + "sleep 0.1; rm " + mine));
  }
  std::size_t most = 0;
  std::vector<std::size_t> ended;
  const auto results = JobRunner({.parallel = 3}).run(jobs, [&](const JobEvent& event) {
    most = std::max(most, event.running);
    EXPECT_EQ(9u, event.total);
    if (event.kind == JobEvent::Kind::kEnded) {
      ended.push_back(event.ended);
      EXPECT_TRUE(event.result->ok());
    }
  });
  EXPECT_EQ(3u, most);
  EXPECT_THAT(ended, ::testing::ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, 9));
  int seen_by_jobs = 0;
  for (const auto& job : jobs) seen_by_jobs = std::max(seen_by_jobs, std::stoi(contentOf(job.log)));
  EXPECT_LE(seen_by_jobs, 3);
}

TEST_F(JobRunnerTest, SaysWhyAJobCouldNotBegin) {
  Job absent = shell("absent", "");
  absent.program = folder_ / "no_such_program";
  const auto results = JobRunner({.parallel = 2}).run({absent, shell("next", "exit 0")});
  EXPECT_EQ(Status::kNotStarted, results[0].status);
  EXPECT_THAT(results[0].text(), ::testing::HasSubstr("No such file"));
  EXPECT_FALSE(results[0].ok());
  EXPECT_TRUE(results[1].ok());
}

TEST_F(JobRunnerTest, RefusesWhatCannotWork) {
  EXPECT_THROW(JobRunner({.parallel = 0}), Error);
  Job job = shell("log", "exit 0");
  job.log = "/dev/null/log";
  EXPECT_THROW(JobRunner().run({job}), Error);
  EXPECT_TRUE(JobRunner().run({}).empty());
}

TEST_F(JobRunnerTest, EndsTheChildrenWhenTheObserverThrows) {
  const Job job = shell("endless", "sleep 60");
  EXPECT_THROW(JobRunner().run({job}, [](const JobEvent&) { throw Error("stop"); }), Error);
  EXPECT_TRUE(JobRunner().run({shell("again", "exit 0")})[0].ok());
}

TEST_F(JobRunnerTest, LeavesNothingOfAJobBehind) {
  // The job ends, its own child would go on.
  const Job job = shell("parent", "sleep 60 & echo $! > pid");
  ASSERT_TRUE(JobRunner().run({job})[0].ok());
  const auto stat = "/proc/" + std::to_string(std::stoi(contentOf(folder_ / "pid"))) + "/stat";
  for (int i = 0; i < 100; ++i) {  // gone, or a zombie that waits for init
    const std::string text = contentOf(stat);
    if (text.empty() || text.find(") Z") != std::string::npos) return;
    ::usleep(50'000);
  }
  FAIL() << "still there: " << contentOf(stat);
}

}  // namespace
}  // namespace colonnade
