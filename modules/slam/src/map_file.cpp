// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/map_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <set>

#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"

namespace colonnade {
namespace {

constexpr const char* kMagic = "colonnade-map";
constexpr const char* kVersion = "4";
constexpr double kFarthest_m = 1e6;
constexpr const char* kSources[] = {"camera", "readings"};

/// FNV-1a, 64 bits (Fowler, Noll, Vo; RFC 9923): finds damage, not malice.
std::string checksum(std::string_view text) {
  std::uint64_t hash = 14695981039346656037ull;
  for (const char c : text) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 1099511628211ull;
  }
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string digits(16, '0');
  for (std::size_t i = 16; i-- > 0; hash >>= 4) digits[i] = kDigits[hash & 15u];
  return digits;
}

class Writer {
 public:
  explicit Writer(const char* key) : line_(key) {}
  Writer& add(double value) { return word(formatDouble(value)); }
  Writer& add(int value) { return word(std::to_string(value)); }
  Writer& add(LandmarkId id) { return add(static_cast<int>(number(id))); }
  Writer& word(const std::string& text) {
    line_ += " " + text;
    return *this;
  }
  std::string line() const { return line_ + "\n"; }

 private:
  std::string line_;
};

/// The words of the file, line by line; every mistake is damage at a line.
class Reader {
 public:
  Reader(std::string_view text, std::string where) : text_(text), where_(std::move(where)) {}

  void expect(const std::string& key) {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    rest_ = text_.substr(at_, end - at_);
    at_ = std::min(end + 1, text_.size());
    ++line_;
    if (rest_.empty() || word() != key) fail("'" + key + "' expected");
  }
  std::string_view word() {
    if (rest_.empty()) fail("the line is too short");
    const std::string_view word = rest_.substr(0, rest_.find(' '));
    rest_.remove_prefix(std::min(word.size() + 1, rest_.size()));
    return word;
  }
  double number() {
    const std::string_view text = word();
    const auto value = parseDouble(text);
    if (!value || !std::isfinite(*value)) fail("no number: " + std::string(text));
    return *value;
  }
  int integer(int low = -2000000000, int high = 2000000000) {
    const double value = number();
    if (!(value >= low && value <= high) || value != std::floor(value)) fail("number out of range");
    return static_cast<int>(value);
  }
  LandmarkId id() { return LandmarkId{integer(0)}; }
  SavedMap::Source source() {
    const std::string_view name = word();
    const auto* const found = std::find(std::begin(kSources), std::end(kSources), name);
    if (found == std::end(kSources))
      fail("maps are made from camera or readings, not " + std::string(name));
    return static_cast<SavedMap::Source>(found - std::begin(kSources));
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(where_ + ":" + std::to_string(line_) + ": damaged map: " + what);
  }

 private:
  std::string_view text_;
  std::string where_;
  std::size_t at_ = 0;
  std::size_t line_ = 0;
  std::string_view rest_;  ///< of the line
};

std::string blockLine(const State& state, const Block& block) {
  Writer w("block");
  const Evidence& e = block.evidence;
  w.add(block.id)
      .add(static_cast<int>(block.block_kind))
      .add(static_cast<int>(block.landmark_kind));
  w.add(e.observations).add(e.first_stamp_s).add(e.last_stamp_s);
  w.add(e.along_min_m).add(e.along_max_m);
  for (const double value : state.values(block)) w.add(value);
  return w.line();
}

void readBlock(Reader& reader, State& state) {
  reader.expect("block");
  Block block;
  block.id = reader.id();
  if (!state.blocks.empty() && block.id <= state.blocks.back().id)
    reader.fail("identities disordered");
  block.block_kind = static_cast<BlockKind>(reader.integer(0, static_cast<int>(BlockKind::kAxis)));
  block.landmark_kind = static_cast<LandmarkKind>(reader.integer(0, kLandmarkKinds - 1));
  block.evidence.observations = reader.integer(0);
  block.evidence.first_stamp_s = reader.number();
  block.evidence.last_stamp_s = reader.number();
  block.evidence.along_min_m = reader.number();
  block.evidence.along_max_m = reader.number();
  block.offset = static_cast<int>(state.x.size());
  state.x.conservativeResize(block.offset + block.size());
  for (int i = 0; i < block.size(); ++i) state.x(block.offset + i) = reader.number();
  state.blocks.push_back(block);
}

/// No correlation beyond one, but for rounding.
bool isCovariance(const Eigen::MatrixXd& P) {
  const Eigen::ArrayXd sigma = P.diagonal().array().sqrt();
  for (Eigen::Index column = 0; column < P.cols(); ++column)
    if (!(P.col(column).array().abs() <= (1.0 + 1e-6) * sigma(column) * sigma + 1e-12).all())
      return false;
  return true;
}

}  // namespace

std::string MapFile::text(const SavedMap& map) {
  const State& state = map.state;
  std::string text = std::string(kMagic) + " " + kVersion + "\n";
  text += Writer("source").word(kSources[static_cast<int>(map.source)]).line();
  text += Writer("start")
              .add(map.T_world_start.x)
              .add(map.T_world_start.y)
              .add(map.T_world_start.phi)
              .line();
  text += Writer("way").add(map.book.way_m_).line();
  text += Writer("blocks").add(static_cast<int>(state.blocks.size())).line();
  for (const Block& block : state.blocks) text += blockLine(state, block);
  // The lower triangle, row by row, without the robot.
  for (Eigen::Index row = 3; row < state.x.size(); ++row) {
    Writer w("covariance");
    for (Eigen::Index column = 3; column <= row; ++column) w.add(state.P(row, column));
    text += w.line();
  }
  text += Writer("identities").add(static_cast<int>(map.identities.size())).line();
  for (const auto& [id, identity] : map.identities)
    text += Writer("identity").add(id).add(identity).line();
  text += Writer("pages").add(static_cast<int>(map.book.pages_.size())).line();
  for (const auto& [id, page] : map.book.pages_) {
    Writer w("page");
    w.add(id)
        .add(page.looks.gradient_balance_)
        .add(page.looks.sightings_)
        .add(page.looks.joint_balance_)
        .add(page.looks.width_m_)
        .add(page.first_m)
        .add(page.last_m);
    for (const float value : page.looks.left_) w.add(static_cast<double>(value));
    for (const float value : page.looks.right_) w.add(static_cast<double>(value));
    w.add(static_cast<int>(page.partners.size()));
    for (const auto& [other, count] : page.partners) w.add(other).add(count);
    w.add(static_cast<int>(page.company.size()));
    for (const LandmarkId other : page.company) w.add(other);
    text += w.line();
  }
  Writer axes("axes");
  axes.add(static_cast<int>(map.axes.size()));
  for (const LandmarkId id : map.axes) axes.add(id);
  text += axes.line();
  text += Writer("hallways").add(static_cast<int>(map.hallways.size())).line();
  for (const Hallway& h : map.hallways)
    text += Writer("hallway")
                .add(h.number)
                .add(h.direction)
                .add(h.p_world.x())
                .add(h.p_world.y())
                .add(h.along_min_m)
                .add(h.along_max_m)
                .add(h.left_m)
                .add(h.right_m)
                .line();
  return text + "checksum " + checksum(text) + "\n";
}

SavedMap MapFile::read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file)
    throw Error(path.string() + ": cannot be read; a map is written by: colonnade run LOG");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::string first = text.substr(0, std::min(text.find('\n'), std::size_t{80}));
  const auto head = words(first);
  if (head.size() != 2 || head[0] != kMagic)
    throw Error(path.string() + ": no map of Colonnade; give the map.colonnade of a former run");
  if (head[1] != kVersion)
    throw Error(path.string() + ": map of version " + head[1] + ", this program reads version " +
                kVersion + "; make the map again");
  const std::size_t seal = text.rfind("checksum ");
  if (seal == std::string::npos || text.size() != seal + 9 + 17 || text.back() != '\n' ||
      text.substr(seal + 9, 16) != checksum(std::string_view(text).substr(0, seal)))
    throw Error(path.string() + ": damaged map: its checksum does not fit; make the map again");

  SavedMap map;
  State& state = map.state;
  Reader reader(std::string_view(text).substr(0, seal), path.string());
  reader.expect(kMagic);
  reader.expect("source");
  map.source = reader.source();
  reader.expect("start");
  map.T_world_start.x = reader.number();
  map.T_world_start.y = reader.number();
  map.T_world_start.phi = reader.number();
  reader.expect("way");
  map.book.way_m_ = reader.number();
  reader.expect("blocks");
  for (int left = reader.integer(0); left > 0; --left) readBlock(reader, state);
  // Every number of the covariance takes a blank and a digit.
  if (static_cast<double>(state.x.size()) * static_cast<double>(state.x.size()) >
      static_cast<double>(seal))
    reader.fail("more landmarks than covariances");
  state.P = Eigen::MatrixXd::Zero(state.x.size(), state.x.size());
  for (Eigen::Index row = 3; row < state.x.size(); ++row) {
    reader.expect("covariance");
    for (Eigen::Index column = 3; column <= row; ++column)
      state.P(row, column) = state.P(column, row) = reader.number();
  }
  if (!isCovariance(state.P) || !(state.x.cwiseAbs().maxCoeff() < kFarthest_m))
    reader.fail("numbers that no map holds");
  reader.expect("identities");
  std::set<int> identities;
  for (int left = reader.integer(0); left > 0; --left) {
    reader.expect("identity");
    const LandmarkId id = reader.id();
    const int identity = reader.integer(0);
    if (!state.find(id) || !map.identities.emplace(id, identity).second ||
        !identities.insert(identity).second)
      reader.fail("an identity of no landmark, or one twice");
  }
  reader.expect("pages");
  for (int left = reader.integer(0); left > 0; --left) {
    reader.expect("page");
    LandmarkBook::Page& page = map.book.pages_[reader.id()];
    page.looks.gradient_balance_ = reader.integer();
    page.looks.sightings_ = reader.integer(0);
    page.looks.joint_balance_ = reader.integer();
    page.looks.width_m_ = reader.number();
    page.first_m = reader.number();
    page.last_m = reader.number();
    for (float& value : page.looks.left_) value = static_cast<float>(reader.number());
    for (float& value : page.looks.right_) value = static_cast<float>(reader.number());
    for (int n = reader.integer(0); n > 0; --n) {
      const LandmarkId other = reader.id();
      page.partners[other] = reader.integer(0);
    }
    for (int n = reader.integer(0); n > 0; --n) page.company.insert(reader.id());
  }
  reader.expect("axes");
  for (int n = reader.integer(0); n > 0; --n) {
    map.axes.push_back(reader.id());
    const Block* block = state.find(map.axes.back());
    if (!block || block->block_kind != BlockKind::kAxis) reader.fail("an axis that is none");
  }
  reader.expect("hallways");
  for (int n = reader.integer(0); n > 0; --n) {
    reader.expect("hallway");
    Hallway h;
    h.number = reader.integer(0);
    h.direction = reader.number();
    h.p_world.x() = reader.number();
    h.p_world.y() = reader.number();
    h.along_min_m = reader.number();
    h.along_max_m = reader.number();
    h.left_m = reader.number();
    h.right_m = reader.number();
    map.hallways.push_back(h);
  }
  return map;
}

}  // namespace colonnade
