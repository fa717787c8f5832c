// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/campaign/campaign_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>

#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"

namespace colonnade {
namespace {

constexpr std::size_t kMostSeeds = 100'000;

std::optional<std::uint64_t> wholeNumber(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Takes the statements of a file, one a line, and complains with file and line.
class Reader {
 public:
  explicit Reader(std::filesystem::path path) : path_(std::move(path)) {}

  void take(const std::string& line) {
    ++line_;
    words_ = words(line.substr(0, line.find('#')));
    if (words_.empty()) return;
    const std::string& keyword = words_.front();
    if (keyword == "world") {
      world();
    } else if (keyword == "seeds") {
      seeds();
    } else if (keyword == "configuration") {
      configuration();
    } else if (keyword == "failure") {
      failure();
    } else if (keyword == "timeout_s") {
      campaign_.timeout_s = positive(word(1, "seconds"), "timeout_s");
      if (words_.size() > 2) fail("timeout_s takes one number");
    } else {
      fail("unknown statement '" + keyword +
           "'; known: world, seeds, configuration, failure, timeout_s");
    }
  }

  Campaign finish() {
    for (const auto& [missing, what] : {std::pair{campaign_.worlds.empty(), "world NAME FILE"},
                                        std::pair{campaign_.seeds.empty(), "seeds 1..10"}}) {
      if (missing)
        throw Error(path_.string() + ": no statement such as '" + what + "'", ExitCode::kUsage);
    }
    if (campaign_.configurations.empty())
      campaign_.configurations.push_back({"default", "", {}, {}});
    return std::move(campaign_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(path_.string() + ":" + std::to_string(line_) + ": " + what, ExitCode::kUsage);
  }

  const std::string& word(std::size_t index, const char* meaning) const {
    if (index >= words_.size()) fail(words_.front() + ": " + meaning + " is missing");
    return words_[index];
  }

  double positive(const std::string& text, const std::string& key) const {
    const auto value = parseDouble(text);
    if (!value || !std::isfinite(*value) || *value <= 0.0)
      fail(key + " must be a number above 0, not '" + text + "'");
    return *value;
  }

  template <class Things>
  std::string newName(const Things& things) const {
    const std::string& name = word(1, "a name");
    const auto allowed = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
             c == '_' || c == '-';
    };
    if (!std::all_of(name.begin(), name.end(), allowed))
      fail("name '" + name + "': only letters, digits, _ and -, since it names a folder");
    for (const auto& thing : things)
      if (thing.name == name) fail(words_.front() + " '" + name + "' stands above already");
    return name;
  }

  /// Section.key=value as `--set` takes it, or nothing where the word is no such thing.
  bool isAssignment(const std::string& word) const {
    const auto equals = word.find('=');
    const auto dot = word.find('.');
    return equals != std::string::npos && dot != std::string::npos && dot > 0 && dot + 1 < equals;
  }

  std::string resolved(const std::string& file) const {
    const auto path = (path_.parent_path() / file).lexically_normal();
    if (!std::filesystem::is_regular_file(path)) fail(path.string() + ": no such file");
    return path.string();
  }

  void world() {
    CampaignWorld world;
    world.name = newName(campaign_.worlds);
    const std::string& source = word(2, "a world file or random:SEED");
    for (std::size_t i = 3; i < words_.size(); ++i) {
      if (isAssignment(words_[i])) {
        world.amendments.push_back(words_[i]);
      } else if (words_[i].starts_with("laps=")) {
        const auto laps = wholeNumber(words_[i].substr(5));
        if (!laps || *laps < 1 || *laps > 1000) fail("laps must be 1 to 1000: '" + words_[i] + "'");
        world.amendments.push_back("route.laps=" + std::to_string(*laps));
      } else {
        fail("'" + words_[i] +
             "' is neither laps=N nor section.key=value, such as camera.rate_hz=5");
      }
    }
    const std::string random = "random:";
    if (!source.starts_with(random)) {
      world.source = resolved(source);
      campaign_.worlds.push_back(world);
      return;
    }
    const std::string range = source.substr(random.size());
    const auto list = numbersOf(range);
    for (const std::uint64_t number : list) {
      CampaignWorld one = world;
      one.source = random + std::to_string(number);
      if (list.size() > 1) one.name += "-" + std::to_string(number);
      campaign_.worlds.push_back(one);
    }
  }

  /// "7" or "1..50".
  std::vector<std::uint64_t> numbersOf(const std::string& range) const {
    const auto dots = range.find("..");
    const auto first = wholeNumber(range.substr(0, dots));
    const auto last = dots == std::string::npos ? first : wholeNumber(range.substr(dots + 2));
    if (!first || !last) fail("'" + range + "' is no seed and no range such as 1..50");
    if (*last < *first) fail("the range " + range + " runs backwards");
    if (*last - *first >= kMostSeeds) fail("the range " + range + " is longer than 100000");
    std::vector<std::uint64_t> numbers;
    for (std::uint64_t i = 0; i <= *last - *first; ++i) numbers.push_back(*first + i);
    return numbers;
  }

  void seeds() {
    word(1, "a seed or a range such as 1..50");
    for (std::size_t i = 1; i < words_.size(); ++i) {
      for (const std::uint64_t seed : numbersOf(words_[i])) {
        if (std::find(campaign_.seeds.begin(), campaign_.seeds.end(), seed) !=
            campaign_.seeds.end())
          fail("seed " + std::to_string(seed) + " stands there twice");
        campaign_.seeds.push_back(seed);
      }
    }
    if (campaign_.seeds.size() > kMostSeeds) fail("more than 100000 seeds");
  }

  void configuration() {
    CampaignConfiguration configuration;
    configuration.name = newName(campaign_.configurations);
    for (std::size_t i = 2; i < words_.size(); ++i) {
      const std::string& word = words_[i];
      if (word.starts_with("backend=")) {
        configuration.backend = word.substr(8);
      } else if (word.starts_with("file=")) {
        configuration.file = resolved(word.substr(5));
      } else if (isAssignment(word)) {
        configuration.assignments.push_back(word);
      } else {
        fail("'" + word + "' is neither backend=, file= nor Section.key=value, such as " +
             "Filter.invariant=false");
      }
    }
    campaign_.configurations.push_back(configuration);
  }

  void failure() {
    word(1, "ate_m= or coverage=");
    for (std::size_t i = 1; i < words_.size(); ++i) {
      const auto equals = words_[i].find('=');
      const std::string key = words_[i].substr(0, equals);
      if (equals == std::string::npos || (key != "ate_m" && key != "coverage"))
        fail("'" + words_[i] + "': the rule for failures knows ate_m= and coverage=");
      const double value = positive(words_[i].substr(equals + 1), key);
      if (key == "coverage" && value > 1.0) fail("coverage is a share, at most 1");
      (key == "ate_m" ? campaign_.failure.max_ate_m : campaign_.failure.min_coverage) = value;
    }
  }

  std::filesystem::path path_;
  int line_ = 0;
  std::vector<std::string> words_;
  Campaign campaign_;
};

}  // namespace

Campaign parseCampaign(std::string_view text, const std::filesystem::path& path) {
  Reader reader(path);
  std::istringstream lines{std::string(text)};
  for (std::string line; std::getline(lines, line);) reader.take(trimmed(line));
  return reader.finish();
}

Campaign readCampaign(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  if (!file || std::filesystem::is_directory(path) || !(text << file.rdbuf()))
    throw Error(path.string() + ": cannot be read as a campaign file", ExitCode::kUsage);
  return parseCampaign(text.str(), path);
}

}  // namespace colonnade
