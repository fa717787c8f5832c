// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/accelerator/accelerator.hpp"

#include <gmock/gmock.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "colonnade/accelerator/model_transport.hpp"
#include "colonnade/accelerator/rtl_backend.hpp"
#include "colonnade/base/error.hpp"
#include "colonnade/edges/accelerator_registers.hpp"
#include "shared_data.hpp"

namespace colonnade {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::SizeIs;

const cv::Size kSize{320, 240};

cv::Mat scene(int seed) {
  cv::RNG random(static_cast<std::uint64_t>(seed));
  cv::Mat image(kSize, CV_8UC1, cv::Scalar(90));
  for (int i = 0; i < 9; ++i) {
    cv::line(image, {random.uniform(0, 320), random.uniform(0, 240)},
             {random.uniform(0, 320), random.uniform(0, 240)}, cv::Scalar(random.uniform(0, 256)),
             5);
  }
  cv::GaussianBlur(image, image, {}, 0.8);
  return image;
}

FixedParameters parametersFor(const EdgeOptions& options = {}) {
  return runParameters(runShape(), options, {}, kSize.width, kSize.height);
}

/// A device between the host and the model that does what broken ones do.
class Saboteur : public AcceleratorTransport {
 public:
  enum class Deed {
    kNone,
    kSwallowFrame,
    kStall,
    kFlipEdge,
    kDropLine,
    kCutFrame,
    kLongLines,
    kWrongSize,
    kTallFrame,
    kWriteInMidFrame
  };
  explicit Saboteur(const cv::Size& size) : model_(makeModelTransport(size)) {}
  Deed deed = Deed::kNone;  // done once, to the next frame

  std::uint32_t readRegister(std::uint32_t offset) override { return model_->readRegister(offset); }
  void writeRegister(std::uint32_t offset, std::uint32_t value) override {
    model_->writeRegister(offset, value);
  }
  void sendFrame(const cv::Mat& gray) override {
    if (done(Deed::kSwallowFrame)) return;
    if (done(Deed::kStall)) return model_->sendFrame(gray.rowRange(0, 100));
    if (done(Deed::kLongLines) || done(Deed::kWrongSize) || done(Deed::kTallFrame)) return model_->sendFrame(bent_);
    if (done(Deed::kCutFrame)) {
      model_->sendFrame(gray.rowRange(0, 200));  // the start of the next one ends it
    }
    model_->sendFrame(gray);
    if (done(Deed::kWriteInMidFrame)) {
      model_->advance(30000);  // its memories are cleared first
      model_->writeRegister(registers::kThresholds, 90U << 16 | 60U);
    }
  }
  /// What goes out in place of the next frame.
  void bend(Deed how, const cv::Size& size) {
    deed = how;
    bent_ = cv::Mat(size, CV_8UC1, cv::Scalar(7));
  }
  bool allSent() const override { return model_->allSent(); }
  void advance(int clocks) override { model_->advance(clocks); }
  std::optional<std::vector<std::uint8_t>> takeEdges() override {
    auto edges = model_->takeEdges();
    if (edges && done(Deed::kFlipEdge)) edges->at(5000) ^= 8;
    return edges;
  }
  std::optional<std::vector<std::uint32_t>> takePacket() override {
    auto packet = model_->takePacket();
    if (packet && packet->size() > 3 && done(Deed::kDropLine)) packet->erase(packet->begin() + 1);
    return packet;
  }
  void reset() override { model_->reset(); }

 private:
  bool done(Deed which) {
    if (deed != which) return false;
    deed = Deed::kNone;
    return true;
  }
  std::unique_ptr<AcceleratorTransport> model_;
  cv::Mat bent_;
};

class SabotagedAccelerator : public ::testing::Test {
 protected:
  SabotagedAccelerator() : SabotagedAccelerator(std::make_unique<Saboteur>(kSize)) {}
  Saboteur& device_;
  Accelerator accelerator_;

 private:
  explicit SabotagedAccelerator(std::unique_ptr<Saboteur> saboteur)
      : device_(*saboteur), accelerator_(std::move(saboteur), runShape()) {}
};

TEST(Accelerator, WorksOnTwoFramesAtATimeWithParametersOfTheirOwn) {
  Accelerator accelerator(makeModelTransport(kSize), runShape());
  EXPECT_EQ(accelerator.size(), kSize);
  FixedStage stage(runShape());
  std::vector<FixedParameters> parameters(3, parametersFor());
  parameters[1].low = 40;
  parameters[1].high = 120;
  parameters[2].vertical_from_deg = -30;
  parameters[2].first_row = 100;
  std::vector<std::uint16_t> ids;
  const auto submit = [&](std::size_t i) {
    accelerator.configure(parameters[i]);
    ids.push_back(accelerator.submit(scene(static_cast<int>(i))));
  };
  const auto expectNext = [&](std::size_t i) {
    const auto result = accelerator.wait();
    EXPECT_EQ(result.frame_id, ids[i]);
    EXPECT_EQ(result.fault, AcceleratorFault::kNone) << result.detail;
    const auto expected = stage.process(scene(static_cast<int>(i)), parameters[i]);
    EXPECT_EQ(cv::norm(result.found.edges, expected.edges, cv::NORM_L1), 0.0);
    EXPECT_TRUE(result.found.lines == expected.lines);
    EXPECT_GT(result.clocks, static_cast<std::uint32_t>(kSize.area()));
  };
  submit(0);
  submit(1);
  EXPECT_FALSE(accelerator.canSubmit());
  EXPECT_THROW(accelerator.submit(scene(2)), Error);
  expectNext(0);
  submit(2);
  expectNext(1);
  expectNext(2);
  EXPECT_FALSE(accelerator.poll());
  EXPECT_THROW(accelerator.wait(), Error);
}

TEST(Accelerator, RefusesWhatDoesNotFit) {
  Accelerator accelerator(makeModelTransport(kSize), runShape());
  EXPECT_THROW(accelerator.submit(cv::Mat(240, 319, CV_8UC1)), Error);
  EXPECT_THROW(accelerator.submit(cv::Mat(kSize, CV_8UC3)), Error);
  FixedShape other = runShape();
  other.hysteresis_passes = 5;
  EXPECT_THROW(Accelerator(makeModelTransport(kSize), other), Error);
  EXPECT_EQ(makeModelTransport({321, 240}), nullptr);
}

TEST_F(SabotagedAccelerator, NamesAHangAndWorksOnAfterIt) {
  accelerator_.configure(parametersFor());
  device_.deed = Saboteur::Deed::kSwallowFrame;
  accelerator_.submit(scene(1));
  const auto hang = accelerator_.wait();
  EXPECT_EQ(hang.fault, AcceleratorFault::kHang);
  EXPECT_THAT(hang.detail, HasSubstr("clocks"));
  accelerator_.configure(parametersFor());
  const auto id = accelerator_.submit(scene(2));
  const auto next = accelerator_.wait();
  EXPECT_EQ(next.fault, AcceleratorFault::kNone) << next.detail;
  EXPECT_EQ(next.frame_id, id);
  EXPECT_TRUE(next.found.lines == FixedStage(runShape()).process(scene(2), parametersFor()).lines);
}

TEST_F(SabotagedAccelerator, PollingAloneBringsResultsAndHangs) {
  const auto polled = [&] {
    for (int i = 0; i < 5000; ++i) {
      if (auto result = accelerator_.poll()) return *result;
    }
    AcceleratorResult never;
    never.detail = "never";
    return never;
  };
  accelerator_.configure(parametersFor());
  accelerator_.submit(scene(1));
  const auto found = polled();
  EXPECT_EQ(found.fault, AcceleratorFault::kNone) << found.detail;
  EXPECT_TRUE(found.found.lines == FixedStage(runShape()).process(scene(1), parametersFor()).lines);
  device_.bend(Saboteur::Deed::kWrongSize, {300, 200});
  accelerator_.submit(scene(2));
  const auto hang = polled();
  EXPECT_EQ(hang.fault, AcceleratorFault::kHang);
  EXPECT_THAT(hang.detail, HasSubstr("a line too short"));
}

TEST_F(SabotagedAccelerator, DoesNotTakeTheSecondFrameForAFirstThatGotLost) {
  accelerator_.configure(parametersFor());
  device_.deed = Saboteur::Deed::kSwallowFrame;
  const auto first = accelerator_.submit(scene(1));
  const auto second = accelerator_.submit(scene(2));
  const auto wrong = accelerator_.wait();
  EXPECT_EQ(wrong.frame_id, first);
  EXPECT_EQ(wrong.fault, AcceleratorFault::kBadPacket);
  EXPECT_THAT(wrong.detail, HasSubstr("1 frames of 2"));
  const auto lost = accelerator_.wait();
  EXPECT_EQ(lost.frame_id, second);
  EXPECT_EQ(lost.fault, AcceleratorFault::kHang);
  EXPECT_THAT(lost.detail, HasSubstr("lost"));
  accelerator_.submit(scene(3));
  EXPECT_EQ(accelerator_.wait().fault, AcceleratorFault::kNone);
}

TEST(RtlBackend, AnswersAsFixedWhateverTheDeviceDoes) {
  const auto fixed = makeEdgeLineBackend("fixed", {});
  const struct {
    Saboteur::Deed deed;
    const char* named;
  } cases[] = {{Saboteur::Deed::kFlipEdge, "edges differ"},
               {Saboteur::Deed::kDropLine, "broken packet"},
               {Saboteur::Deed::kCutFrame, "broken frame"},
               {Saboteur::Deed::kSwallowFrame, "hangs"},
               {Saboteur::Deed::kStall, "hangs"},
               {Saboteur::Deed::kLongLines, "broken frame"},
               {Saboteur::Deed::kWrongSize, "hangs"},
               {Saboteur::Deed::kTallFrame, "broken frame"},
               {Saboteur::Deed::kWriteInMidFrame, "written in mid-frame"}};
  for (const auto& c : cases) {
    SCOPED_TRACE(c.named);
    Saboteur* device = nullptr;
    RtlBackend backend({}, [&](const cv::Size& size) {
      auto transport = std::make_unique<Saboteur>(size);
      device = transport.get();
      device->bend(c.deed, c.deed == Saboteur::Deed::kLongLines   ? cv::Size(330, 240)
                           : c.deed == Saboteur::Deed::kTallFrame ? cv::Size(320, 242)
                                                                  : cv::Size(300, 200));
      return transport;
    });
    for (int i = 0; i < 2; ++i) {
      const auto expected = fixed->extract(scene(i));
      const auto found = backend.extract(scene(i));
      EXPECT_EQ(cv::norm(found.edges, expected.edges, cv::NORM_L1), 0.0);
      ASSERT_EQ(found.lines.size(), expected.lines.size());
      for (std::size_t k = 0; k < found.lines.size(); ++k) {
        EXPECT_EQ(found.lines[k].theta_index, expected.lines[k].theta_index);
        EXPECT_EQ(found.lines[k].rho_bin, expected.lines[k].rho_bin);
        EXPECT_EQ(found.lines[k].votes, expected.lines[k].votes);
      }
    }
    EXPECT_THAT(backend.notes(), Contains(AllOf(HasSubstr(c.named), HasSubstr("CPU"))));
    // The next frame is right on the device itself.
    EXPECT_THAT(backend.notes(), Contains(HasSubstr("1 frames of 320x240 equal to fixed")));
  }
}

TEST(RtlBackend, LeavesSizesWithoutAModelToTheCpuAndSaysSo) {
  const auto backend = makeImageStage("rtl", {});
  cv::Mat image = scene(1)(cv::Rect(0, 0, 200, 200)).clone();
  EXPECT_FALSE(backend->extract(image).lines.empty());
  EXPECT_THAT(backend->notes(), Contains(AllOf(HasSubstr("200x200"), HasSubstr("640x480"))));
}

TEST(RtlBackend, EqualsFixedOnRealFramesOfBothSizes) {
  COLONNADE_REQUIRE_RECORDING(folder, "corridor_xtion");
  const auto backend = makeImageStage("rtl", {});
  for (const char* name : {"0000000005.400000", "0000000008.066667"}) {
    cv::Mat image =
        cv::imread((folder / "rgb" / (std::string(name) + ".jpg")).string(), cv::IMREAD_GRAYSCALE);
    ASSERT_FALSE(image.empty());
    backend->extract(image);
    cv::resize(image, image, kSize, 0, 0, cv::INTER_AREA);
    backend->extract(image);
  }
  EXPECT_THAT(backend->notes(), SizeIs(2));  // no fault, only the clocks of each size
  EXPECT_THAT(backend->notes(), Contains(HasSubstr("2 frames of 320x240 equal to fixed")));
  EXPECT_THAT(backend->notes(), Contains(HasSubstr("2 frames of 640x480 equal to fixed")));
}

TEST(ImageStage, AnUnknownNameIsAUsageErrorThatNamesTheOthers) {
  try {
    makeImageStage("fpga", {});
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kUsage);
    EXPECT_THAT(error.what(), AllOf(HasSubstr("fixed"), HasSubstr("rtl")));
  }
}

}  // namespace
}  // namespace colonnade
