// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "campaign_folder.hpp"

namespace colonnade {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
namespace fs = std::filesystem;

/// Campaigns by the program itself.
class CampaignVerb : public testing::CampaignFolder {
 protected:
  int shell(const std::string& command) {
    const std::string line =
        "cd '" + folder_.string() + "' && { " + command + "; } >stdout.txt 2>stderr.txt </dev/null";
    const int status = std::system(line.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  int campaign(const std::string& arguments) {
    return shell(std::string("'" COLONNADE_PROGRAM "' campaign ") + arguments);
  }
  std::string err() const { return content("stderr.txt"); }
  std::string out() const { return content("stdout.txt"); }
  bool exists(const std::string& name) const { return fs::exists(folder_ / name); }
};

TEST_F(CampaignVerb, MakesOneTableAndRepeatsNothing) {
  const std::string worlds =
      "world hall hall.world\nworld slow hall.world camera.rate_hz=4 odometry.scale=0.02\n"
      "seeds 1 2\n";
  write("t.campaign", worlds + "configuration default\nconfiguration wrong Filter.no_key=1\n");
  EXPECT_EQ(1, campaign("t.campaign -o out --jobs 2"));  // since runs failed
  EXPECT_THAT(err(), HasSubstr("8 of 8 runs to do, in 4 drives, 2 at a time"));
  EXPECT_THAT(err(), HasSubstr("4 of 8 runs failed, 0 are missing; see out/campaign.md"));
  EXPECT_EQ(content("out/campaign.md"), out());
  EXPECT_THAT(out(), HasSubstr("- slow, wrong, seed 2: run: exit 2: "));
  EXPECT_THAT(out(), HasSubstr("Filter.no_key"));
  auto json = nlohmann::json::parse(content("out/campaign.json"));
  ASSERT_EQ(4u, json["rows"].size());
  for (const int row : {0, 2}) {
    EXPECT_EQ(2, json["rows"][row]["done"]);
    EXPECT_EQ(0, json["rows"][row]["failed"]);
    const auto& ate = json["rows"][row]["metrics"]["ate_rmse_m"];
    EXPECT_GT(ate["minimum"], 0.0);
    EXPECT_LT(ate["maximum"], 0.1);
    EXPECT_LT(ate["minimum"], ate["maximum"]);  // another seed, another drive
    EXPECT_EQ(2, json["rows"][row]["nees_at_tenths"][9]["runs"]);
  }
  EXPECT_FALSE(exists("out/logs/hall/seed-1/log.rawlog"));
  EXPECT_TRUE(exists("out/logs/hall/seed-1/log_ground_truth.tum"));
  const std::string csv = content("out/campaign.csv");

  // Again: nothing begins.
  const std::string kept = "out/runs/hall/seed-2/default/results/summary.json";
  const auto time = fs::last_write_time(folder_ / kept);
  EXPECT_EQ(1, campaign("t.campaign -o out"));
  EXPECT_THAT(err(), HasSubstr("0 of 8 runs to do, in 0 drives"));
  EXPECT_EQ(csv, content("out/campaign.csv"));

  // A run without a record was interrupted: it alone is done again, from a clean folder.
  fs::remove(folder_ / "out/runs/hall/seed-1/default/run.json");
  write("out/runs/hall/seed-1/default/results/remnant", "x");
  EXPECT_EQ(1, campaign("t.campaign -o out"));
  EXPECT_THAT(err(), HasSubstr("1 of 8 runs to do, in 1 drives"));
  EXPECT_FALSE(exists("out/runs/hall/seed-1/default/results/remnant"));
  EXPECT_TRUE(exists("out/runs/hall/seed-1/default/results/summary.json"));
  EXPECT_EQ(time, fs::last_write_time(folder_ / kept));

  // Another configuration of that name: refused with the difference, or done again.
  write("t.campaign", worlds + "configuration default Filter.invariant=false\n");
  EXPECT_EQ(2, campaign("t.campaign -o out"));
  EXPECT_THAT(err(), HasSubstr("hall seed 1 default in out/runs/hall/seed-1/default was made in "
                               "another way (run: , now --set Filter.invariant=false)"));
  EXPECT_EQ(time, fs::last_write_time(folder_ / kept));
  EXPECT_EQ(0, campaign("t.campaign -o out --redo --only 1"));
  EXPECT_THAT(out(), HasSubstr("hall seed 2 default: ATE "));
  EXPECT_NE(time, fs::last_write_time(folder_ / kept));
  EXPECT_EQ(1, campaign("t.campaign -o out --collect"));
  EXPECT_THAT(err(), HasSubstr("0 of 4 runs failed, 3 are missing"));
  EXPECT_THAT(out(), HasSubstr("3 of them were made with another program, world or options"));
}

TEST_F(CampaignVerb, GoesOnAfterAnInterruption) {
  write("t.campaign", "world hall hall.world\nseeds 1..2\n");
  EXPECT_EQ(130, shell("'" COLONNADE_PROGRAM "' campaign t.campaign -o out --jobs 1 & pid=$!; "
                       "while ! test -s out/runs/hall/seed-1/default/run.txt; do sleep 0.02; done; "
                       "kill -INT $pid; wait $pid"));
  EXPECT_THAT(err(), HasSubstr("the same command goes on where it stopped"));
  EXPECT_FALSE(exists("out/runs/hall/seed-2/default/run.json"));
  // Nobody is left who holds a drive.
  for (const char* seed : {"1", "2"}) {
    const auto lock = folder_ / "out/logs/hall" / (std::string("seed-") + seed) / ".lock";
    if (!fs::exists(lock)) continue;
    const int file = ::open(lock.c_str(), O_RDWR);
    EXPECT_EQ(0, ::flock(file, LOCK_EX | LOCK_NB)) << seed;
    ::close(file);
  }
  EXPECT_EQ(0, campaign("t.campaign -o out --keep-logs"));
  EXPECT_THAT(err(), Not(HasSubstr("failed")));
  EXPECT_EQ(true, nlohmann::json::parse(content("out/campaign.json"))["complete"]);
  EXPECT_TRUE(exists("out/logs/hall/seed-2/log.rawlog"));
}

TEST_F(CampaignVerb, RunsAsATaskOfAJobArray) {
  write("t.campaign", "world hall hall.world\nseeds 1..2\n");
  ASSERT_EQ(0, campaign("t.campaign -o out --slurm --sbatch=--time=10"));
  EXPECT_THAT(out(), HasSubstr("2 drives, 2 runs"));
  EXPECT_TRUE(exists("out/submit.sh"));
  EXPECT_THAT(content("out/campaign.sbatch"), HasSubstr("#SBATCH --array=0-1\n"));
  ASSERT_EQ(0, shell("SLURM_ARRAY_TASK_ID=1 bash out/campaign.sbatch"));
  EXPECT_TRUE(exists("out/runs/hall/seed-2/default/run.json"));
  EXPECT_FALSE(exists("out/runs/hall/seed-1"));
  EXPECT_EQ(1, shell("bash out/collect.sbatch"));
  EXPECT_THAT(err(), HasSubstr("0 of 2 runs failed, 1 are missing"));
  EXPECT_THAT(content("out/campaign.md"), HasSubstr("| hall | default | 1 of 2 | 0 |"));
}

TEST_F(CampaignVerb, RefusesWhatItCannotDo) {
  write("t.campaign", "world hall hall.world\nseeds 1\n");
  write("foreign/file", "mine");
  EXPECT_EQ(2, campaign("t.campaign -o nowhere --collect"));
  EXPECT_THAT(err(), HasSubstr("nowhere: no campaign has run there"));
  EXPECT_EQ(2, campaign("t.campaign -o foreign"));
  EXPECT_THAT(err(), HasSubstr("neither empty nor a campaign's folder"));
  EXPECT_EQ("mine", content("foreign/file"));
  EXPECT_EQ(2, campaign("absent.campaign -o out"));
  EXPECT_EQ(2, campaign("t.campaign"));
  for (const char* only : {"1", "x", "0..", "-1", "0..1"}) {
    EXPECT_EQ(2, campaign(std::string("t.campaign -o out --only=") + only)) << only;
    EXPECT_THAT(err(), HasSubstr("--only")) << only;
  }
  write("bad.campaign", "world hall hall.world\nseeds 1\nfailure ate_m=0\n");
  EXPECT_EQ(2, campaign("bad.campaign -o out"));
  EXPECT_THAT(err(), HasSubstr("bad.campaign:3: "));
  EXPECT_FALSE(exists("out"));
  // Two processes at one drive would write the same files.
  fs::create_directories(folder_ / "out/logs/hall/seed-1");
  const int lock = ::open((folder_ / "out/logs/hall/seed-1/.lock").c_str(), O_RDWR | O_CREAT, 0644);
  ASSERT_EQ(0, ::flock(lock, LOCK_EX));
  EXPECT_EQ(1, campaign("t.campaign -o out --only 0"));
  EXPECT_THAT(err(), HasSubstr("another process is at it"));
  ::close(lock);
}

TEST_F(CampaignVerb, RecordsAWorldThatCannotBeSimulated) {
  write("broken.world", "wall south 0 0\n");
  write("t.campaign", "world broken broken.world\nseeds 1\nconfiguration a\nconfiguration b\n");
  EXPECT_EQ(1, campaign("t.campaign -o out"));
  EXPECT_THAT(content("out/campaign.md"),
              HasSubstr("- broken, b, seed 1: simulate: exit 2: colonnade: "));
  EXPECT_EQ(1, campaign("t.campaign -o out"));
  EXPECT_THAT(err(), HasSubstr("0 of 2 runs to do"));
  EXPECT_EQ(1, campaign("t.campaign -o out --retry-failed"));
  EXPECT_THAT(err(), HasSubstr("2 of 2 runs to do"));
}

}  // namespace
}  // namespace colonnade
