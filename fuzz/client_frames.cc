// Binary messages of a client of the studio.
#include <cmath>
#include <string>

#include "fuzz/target.h"
#include "studio/frame_codec.h"
#include "studio/frames.h"

namespace hvas::fuzz {

void TestOne(std::string_view bytes) {
  const auto frames = studio::ReadClientFrames(bytes);
  if (!frames) {
    Check(frames.error().code == ErrorCode::kInvalid && !frames.error().message.empty());
    return;
  }
  // Every item was there, and every pose is one.
  std::size_t least = 0;
  least += frames->inputs.size() * sizeof(studio::protocol::HandInput);
  least += frames->credits.size() * sizeof(studio::protocol::Acknowledgement);
  Check(least <= bytes.size());
  for (const auto& input : frames->inputs) {
    const spatial::Pose X_WH = studio::PoseOf(input);
    Check(spatial::IsFinite(X_WH));
    Check(std::abs(X_WH.q().norm() - 1) < 1e-6);
  }
  // The same again when it comes twice in one message.
  const auto twice = studio::ReadClientFrames(std::string(bytes) + std::string(bytes));
  Check(twice && twice->inputs.size() == 2 * frames->inputs.size() &&
        twice->credits.size() == 2 * frames->credits.size());
}

}  // namespace hvas::fuzz
