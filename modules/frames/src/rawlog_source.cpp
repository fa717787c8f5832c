// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/frames/rawlog_source.hpp"

#include "entry_reader.hpp"
#include "frame_assembler.hpp"

namespace colonnade {

struct RawlogSource::Impl {
  Impl(const std::filesystem::path& path, const SourceOptions& options)
      : reader(path), assembler(path, options, reader.damage()) {}

  EntryReader reader;
  FrameAssembler assembler;
  std::size_t delivered = 0;
};

RawlogSource::RawlogSource(const std::filesystem::path& path, const SourceOptions& options)
    : impl_(std::make_unique<Impl>(path, options)) {}
RawlogSource::~RawlogSource() = default;

std::optional<Frame> RawlogSource::next() {
  for (;;) {
    if (auto frame = impl_->assembler.take()) {
      frame->index = impl_->delivered++;
      return frame;
    }
    if (impl_->assembler.finished()) return std::nullopt;
    if (auto entry = impl_->reader.next())
      impl_->assembler.add(*entry);
    else
      impl_->assembler.finish();
  }
}

const Damage& RawlogSource::damage() const { return impl_->reader.damage(); }
double RawlogSource::progress() const { return impl_->reader.stream().progress(); }
const std::vector<std::string>& RawlogSource::notes() const { return impl_->assembler.notes(); }

}  // namespace colonnade
