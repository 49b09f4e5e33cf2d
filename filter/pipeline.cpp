#include "filter/pipeline.h"

#include <array>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <stop_token>
#include <thread>

#include "filter/stages.h"

namespace lcs {

struct FilterPipeline::Impl {
  Impl(const Intrinsics& camera, const Parameters& parameters) : stages(camera, parameters) {
    circle_thread = std::jthread(
        [this](const std::stop_token& stop) { work(stop, lined, circled, &Stages::circle); });
    square_thread = std::jthread(
        [this](const std::stop_token& stop) { work(stop, circled, squared, &Stages::square); });
  }

  Frame& frame(std::int64_t k) { return frames[static_cast<std::size_t>(k % kFrames)]; }
  Frame& frame_before(std::int64_t k) { return frame(k + kFrames - 1); }

  /// An expert's thread: takes each frame as soon as the expert before is done with it.
  void work(const std::stop_token& stop, const std::int64_t& ready, std::int64_t& done,
            void (Stages::*expert)(const Frame&, Frame&)) {
    try {
      for (std::int64_t k = 0;; ++k) {
        {
          std::unique_lock lock(mutex);
          changed.wait(lock, stop, [&] { return problem || ready > k; });
          if (problem || stop.stop_requested()) return;
        }
        (stages.*expert)(frame_before(k), frame(k));
        tell([&] { done = k + 1; });
      }
    } catch (...) {
      tell([&] { problem = std::current_exception(); });
    }
  }

  template <typename Change>
  void tell(Change&& change) {
    const std::lock_guard lock(mutex);
    change();
    changed.notify_all();
  }

  /// Until the Square expert is done with the first `count` frames.
  void wait_for(std::int64_t count) {
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return problem || squared >= count; });
    if (problem) std::rethrow_exception(problem);
  }

  /// One for each expert, and the one before that Square goes on from.
  static constexpr std::int64_t kFrames = kLag + 2;

  Stages stages;
  std::array<Frame, kFrames> frames;
  std::int64_t pushed = 0, given = 0;  // the caller's own
  std::mutex mutex;                    // of what follows
  std::condition_variable_any changed;
  std::int64_t lined = 0, circled = 0, squared = 0;  // frames that each expert is done with
  std::exception_ptr problem;
  std::jthread circle_thread, square_thread;  // the last: they end before what they use
};

FilterPipeline::FilterPipeline(const Intrinsics& camera, const Parameters& parameters)
    : impl_(std::make_unique<Impl>(camera, parameters)) {}
FilterPipeline::~FilterPipeline() = default;
FilterPipeline::FilterPipeline(FilterPipeline&&) noexcept = default;
FilterPipeline& FilterPipeline::operator=(FilterPipeline&&) noexcept = default;

const FrameResult* FilterPipeline::push(std::span<const Eigen::Vector2f> corners_px,
                                        const EgoMotion& motion) {
  Impl& p = *impl_;
  const std::int64_t k = p.pushed++;
  // Nobody looks any more at the frame that had this one's place, nor goes on from it.
  p.wait_for(p.stages.feeds_back() ? k : k - kLag);
  p.stages.line(corners_px, motion, p.frame_before(k), p.frame(k));
  p.tell([&] { p.lined = k + 1; });
  return p.given > k - kLag ? nullptr : drain();
}

const FrameResult* FilterPipeline::drain() {
  Impl& p = *impl_;
  if (p.given == p.pushed) return nullptr;
  p.wait_for(++p.given);
  return &p.frame(p.given - 1).result;
}

const Diagnostics& FilterPipeline::diagnostics() const {
  return impl_->stages.diagnostics();
}

}  // namespace lcs
