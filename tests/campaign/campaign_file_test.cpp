// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "campaign_folder.hpp"

namespace colonnade {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;
class CampaignFile : public testing::CampaignFolder {};

TEST_F(CampaignFile, ReadsEveryStatement) {
  write("good.ini", "[Filter]\n");
  const Campaign campaign = parse(R"(# comment
world hall hall.world laps=2 camera.rate_hz=5 odometry.scale=0  # and another
world other random:7
seeds 3 10..12
configuration default
configuration fixed backend=fixed file=good.ini Filter.invariant=false Axes.enabled=false
failure ate_m=0.5 coverage=0.8
timeout_s 60
)");
  ASSERT_EQ(2u, campaign.worlds.size());
  EXPECT_EQ("hall", campaign.worlds[0].name);
  EXPECT_EQ((folder_ / "hall.world").string(), campaign.worlds[0].source);
  EXPECT_THAT(campaign.worlds[0].amendments,
              ElementsAre("route.laps=2", "camera.rate_hz=5", "odometry.scale=0"));
  EXPECT_EQ("random:7", campaign.worlds[1].source);
  EXPECT_THAT(campaign.seeds, ElementsAre(3, 10, 11, 12));
  ASSERT_EQ(2u, campaign.configurations.size());
  EXPECT_EQ("", campaign.configurations[0].backend);
  EXPECT_EQ("fixed", campaign.configurations[1].backend);
  EXPECT_EQ(folder_ / "good.ini", campaign.configurations[1].file);
  EXPECT_THAT(campaign.configurations[1].assignments,
              ElementsAre("Filter.invariant=false", "Axes.enabled=false"));
  EXPECT_DOUBLE_EQ(0.5, campaign.failure.max_ate_m);
  EXPECT_DOUBLE_EQ(0.8, campaign.failure.min_coverage);
  EXPECT_DOUBLE_EQ(60.0, campaign.timeout_s);
}

TEST_F(CampaignFile, FreezesWithAllItsFiles) {
  write("good.ini", "[Filter]\n");
  const Campaign campaign = parse(
      "world hall hall.world laps=2\nworld r random:4..5\nseeds 3 10..12\nfailure ate_m=0.25\n"
      "configuration fixed backend=fixed file=good.ini Filter.invariant=false\n");
  const auto file = freezeCampaign(campaign, folder_ / "source");
  const Campaign copy = readCampaign(file);
  EXPECT_EQ((folder_ / "source/hall.world").string(), copy.worlds[0].source);
  EXPECT_EQ(campaign.worlds[0].amendments, copy.worlds[0].amendments);
  EXPECT_EQ("random:5", copy.worlds[2].source);
  EXPECT_EQ(campaign.seeds, copy.seeds);
  EXPECT_EQ("fixed", copy.configurations[0].backend);
  EXPECT_EQ(folder_ / "source/fixed.ini", copy.configurations[0].file);
  EXPECT_EQ(campaign.configurations[0].assignments, copy.configurations[0].assignments);
  EXPECT_DOUBLE_EQ(0.25, copy.failure.max_ate_m);
  EXPECT_DOUBLE_EQ(campaign.timeout_s, copy.timeout_s);
  EXPECT_EQ(content("hall.world"), content("source/hall.world"));
}

TEST_F(CampaignFile, TakesARangeOfRandomWorldsAndTheDefaultConfiguration) {
  const Campaign campaign = parse("world r random:4..6 camera.rate_hz=5\nseeds 1\n");
  ASSERT_EQ(3u, campaign.worlds.size());
  EXPECT_EQ("r-5", campaign.worlds[1].name);
  EXPECT_EQ("random:5", campaign.worlds[1].source);
  EXPECT_THAT(campaign.worlds[1].amendments, ElementsAre("camera.rate_hz=5"));
  ASSERT_EQ(1u, campaign.configurations.size());
  EXPECT_EQ("default", campaign.configurations[0].name);
}

TEST_F(CampaignFile, NamesTheLineOfEveryMistake) {
  const std::string begin = "world hall hall.world\nseeds 1..3\n";
  const std::pair<const char*, const char*> mistakes[] = {
      {"wrld a b", "unknown statement 'wrld'"},
      {"world", "a name is missing"},
      {"world hall hall.world", "'hall' stands above already"},
      {"world ../up hall.world", "only letters, digits"},
      {"world other absent.world", "absent.world: no such file"},
      {"world other hall.world rate=5", "neither laps=N nor section.key=value"},
      {"world other hall.world laps=0", "laps must be 1 to 1000"},
      {"world other random:x", "is no seed"},
      {"seeds", "is missing"},
      {"seeds 5..2", "runs backwards"},
      {"seeds 1..9999999", "longer than 100000"},
      {"seeds -4", "is no seed"},
      {"seeds 2", "seed 2 stands there twice"},
      {"configuration a invariant=false", "neither backend=, file= nor Section.key=value"},
      {"configuration a file=absent.ini", "no such file"},
      {"configuration a\nconfiguration a", "stands above already"},
      {"failure ate=1", "knows ate_m= and coverage="},
      {"failure ate_m=-1", "above 0"},
      {"failure coverage=2", "at most 1"},
      {"timeout_s soon", "above 0"},
  };
  for (const auto& [line, complaint] : mistakes) {
    const std::string said = complaintAbout(begin + line + "\n");
    EXPECT_THAT(said, HasSubstr(complaint)) << line;
    const bool second = std::string(line).find('\n') != std::string::npos;
    EXPECT_THAT(said, StartsWith(second ? "x.campaign:4: " : "x.campaign:3: ")) << line;
  }
  EXPECT_THAT(complaintAbout("seeds 1\n"), HasSubstr("no statement such as 'world NAME FILE'"));
  EXPECT_THAT(complaintAbout("world hall hall.world\n"), HasSubstr("'seeds 1..10'"));
  EXPECT_THROW(readCampaign(folder_ / "absent.campaign"), Error);
  EXPECT_THROW(readCampaign(folder_), Error);
}

}  // namespace
}  // namespace colonnade
