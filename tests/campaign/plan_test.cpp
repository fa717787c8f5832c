// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/campaign/plan.hpp"

#include <gmock/gmock.h>

#include "campaign_folder.hpp"
#include "colonnade/campaign/run_record.hpp"
#include "colonnade/campaign/slurm.hpp"

namespace colonnade {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

class Plan : public testing::CampaignFolder {
 protected:
  CampaignPlan plan(const std::string& text, const std::string& program = "p") const {
    return planCampaign(parse(text), folder_ / "out", program);
  }
  const std::string two_ = "world a hall.world\nworld b hall.world camera.rate_hz=4\n";
};

TEST_F(Plan, GoesThroughWorldsThenSeedsThenConfigurations) {
  const auto planned = plan(two_ + "seeds 5 1\nconfiguration x\nconfiguration y\n");
  EXPECT_EQ(8u, planned.runs());
  std::string names;
  for (std::size_t i = 0; i < planned.drives.size(); ++i) {
    EXPECT_EQ(i, planned.drives[i].index);
    for (std::size_t c = 0; c < 2; ++c) {
      EXPECT_EQ(2 * i + c, planned.drives[i].runs[c].index);
      names += planned.drives[i].runs[c].name() + "; ";
    }
  }
  EXPECT_EQ(
      "a seed 5 x; a seed 5 y; a seed 1 x; a seed 1 y; "
      "b seed 5 x; b seed 5 y; b seed 1 x; b seed 1 y; ",
      names);
  EXPECT_EQ(folder_ / "out/runs/b/seed-1/y", planned.drives[3].runs[1].folder);
}

TEST_F(Plan, GivesTheProgramWhatTheFileSays) {
  write("c.ini", "[Filter]\n");
  const auto planned = plan(
      "world w hall.world laps=3 camera.rate_hz=4\nseeds 9\n"
      "configuration c file=c.ini backend=fixed Filter.invariant=false\n");
  const PlannedDrive& drive = planned.drives[0];
  EXPECT_THAT(
      drive.simulate_arguments,
      ::testing::ElementsAre("simulate", folder_ / "hall.world", "-o",
                             folder_ / "out/logs/w/seed-9/log.rawlog", "--seed", "9", "--overwrite",
                             "--set", "route.laps=3", "--set", "camera.rate_hz=4"));
  EXPECT_THAT(drive.runs[0].run_arguments,
              ::testing::ElementsAre(
                  "run", drive.log(), "-o", folder_ / "out/runs/w/seed-9/c/results",
                  "--ground-truth", folder_ / "out/logs/w/seed-9/log_ground_truth.tum", "-c",
                  folder_ / "c.ini", "--backend", "fixed", "--set", "Filter.invariant=false"));
  EXPECT_THAT(drive.runs[0].evaluate_arguments, Contains("--json"));
}

TEST_F(Plan, StampsTellWhatChanged) {
  const std::string text = "world w hall.world\nseeds 9\nconfiguration c Filter.invariant=false\n";
  const auto stamp = [&](const std::string& what, const char* program = "p") {
    return plan(what, program).drives[0].runs[0].stamp;
  };
  const std::string former = stamp(text);
  EXPECT_EQ("", stampDifference(former, stamp(text)));
  // More seeds or configurations change no run there is.
  EXPECT_EQ("", stampDifference(former, stamp("world w hall.world\nseeds 9 1..4\nconfiguration c "
                                              "Filter.invariant=false\nconfiguration d\n")));
  EXPECT_EQ("program: p, now q", stampDifference(former, stamp(text, "q")));
  EXPECT_EQ("run: --set Filter.invariant=false, now --set Filter.invariant=true",
            stampDifference(former, stamp("world w hall.world\nseeds 9\nconfiguration c "
                                          "Filter.invariant=true\n")));
  EXPECT_THAT(stampDifference(former, stamp("world w hall.world camera.rate_hz=2\nseeds 9\n"
                                            "configuration c Filter.invariant=false\n")),
              HasSubstr("now --seed 9 --set camera.rate_hz=2"));
  write("hall.world", content("hall.world") + "# touched\n");
  EXPECT_THAT(stampDifference(former, stamp(text)), HasSubstr("world: "));
}

TEST_F(Plan, WritesAJobArrayOverTheDrives) {
  SlurmOptions options;
  options.program = "/opt/with blank/colonnade";
  options.campaign_file = folder_ / "x.campaign";
  options.directives = {"--time=1:00:00"};
  options.arguments = {"--keep-logs"};
  const auto planned = plan(two_ + "seeds 1..5\n");  // ten drives
  writeSlurmScripts(planned, options);
  const std::string all = content("out/campaign.sbatch");
  EXPECT_THAT(all, HasSubstr("#SBATCH --array=0-9\n"));
  EXPECT_THAT(all, HasSubstr("#SBATCH --time=1:00:00\n"));
  EXPECT_THAT(all, HasSubstr("exec '/opt/with blank/colonnade' campaign "));
  EXPECT_THAT(all, HasSubstr("--only $first..$last --keep-logs\n"));
  EXPECT_THAT(content("out/collect.sbatch"), HasSubstr("--collect\n"));
  EXPECT_THAT(content("out/collect.sbatch"), Not(HasSubstr("--array")));
  options.most_tasks = 4;  // three drives a task, the last task has one
  writeSlurmScripts(planned, options);
  EXPECT_THAT(content("out/campaign.sbatch"), HasSubstr("#SBATCH --array=0-3\n"));
  EXPECT_THAT(content("out/campaign.sbatch"), HasSubstr("first=$((SLURM_ARRAY_TASK_ID * 3))"));
}

}  // namespace
}  // namespace colonnade
