/// \file
/// Accepted ranges of a scenario's numbers. The outer bounds are generous: they catch wrong units
/// (km for m) without limiting large experiments.
#pragma once

#include "scenarios/input/reader.h"

namespace lcs::scenario {

inline constexpr input::Quantity kPosition{input::Dimension::length, {-10000, 10000}};
inline constexpr input::Quantity kSize{input::Dimension::length, {0, 100, true}};
inline constexpr input::Quantity kDistance{input::Dimension::length, {0, 10000, true}};
inline constexpr input::Quantity kTime{input::Dimension::time, {0, 100000}};
inline constexpr input::Quantity kDuration{input::Dimension::time, {0, 100000, true}};
inline constexpr input::Quantity kSpeed{input::Dimension::speed, {0, 100}};
inline constexpr input::Quantity kSignedSpeed{input::Dimension::speed, {-100, 100}};
inline constexpr input::Quantity kAcceleration{input::Dimension::acceleration, {-100, 100}};
inline constexpr input::Quantity kAngle{input::Dimension::angle, {-360, 360}};
inline constexpr input::Quantity kJointAngle{input::Dimension::angle, {-36000, 36000}};
inline constexpr input::Quantity kFieldOfView{input::Dimension::angle, {0, 180, true, true}};
inline constexpr input::Quantity kFocal{input::Dimension::pixels, {1, 1e6}};
inline constexpr input::Quantity kInPicture{input::Dimension::pixels, {-100000, 100000}};
inline constexpr input::Quantity kCoefficient{input::Dimension::number, {-1000, 1000}};
inline constexpr input::Quantity kAngularRate{input::Dimension::angular_rate, {-720, 720}};
/// Of the camera. At the lowest rate, ten seconds of physics lie between two frames.
inline constexpr input::Quantity kCameraRate{input::Dimension::frequency, {0.1, 1000}};
inline constexpr input::Quantity kSensorRate{input::Dimension::frequency, {0, 10000, true}};
inline constexpr input::Quantity kNoiseDensity{input::Dimension::number, {0, 1000}};
inline constexpr input::Quantity kIlluminance{input::Dimension::illuminance, {0, 200000}};
inline constexpr input::Quantity kIntensity{input::Dimension::intensity, {0, 1000000}};
inline constexpr input::Quantity kContrast{input::Dimension::number, {0.01, 10}};
inline constexpr input::Quantity kNoiseRate{input::Dimension::frequency, {0, 10000}};
inline constexpr input::Quantity kDarkLight{input::Dimension::illuminance, {1e-6, 200000}};
inline constexpr input::Quantity kBeam{input::Dimension::angle, {0, 90, true}};
inline constexpr input::Quantity kBlur{input::Dimension::number, {0, 50}};
inline constexpr input::Quantity kDropLife{input::Dimension::time, {0.01, 100000}};
inline constexpr input::Quantity kRainRate{input::Dimension::number, {0, 200}};
inline constexpr input::Quantity kExposure{input::Dimension::time, {0, 10, true}};
inline constexpr input::Quantity kShutter{input::Dimension::time, {0, 10}};
inline constexpr input::Quantity kTimeOffset{input::Dimension::time, {-10, 10}};
inline constexpr input::Quantity kGain{input::Dimension::number, {0, 1000, true}};
inline constexpr input::Quantity kElectrons{input::Dimension::number, {0, 1000000}};
inline constexpr input::Quantity kFullWell{input::Dimension::number, {0, 1000000, true}};
inline constexpr input::Quantity kYawNoise{input::Dimension::angular_rate, {0, 720}};
inline constexpr input::Quantity kTurnOnRate{input::Dimension::angular_rate, {0, 720}};
inline constexpr input::Quantity kTurnOnAcceleration{input::Dimension::acceleration, {0, 100}};
inline constexpr input::Quantity kImuRate{input::Dimension::angular_rate, {0, 36000, true}};
inline constexpr input::Quantity kImuAcceleration{input::Dimension::acceleration, {0, 10000, true}};
inline constexpr input::Quantity kRoughness{input::Dimension::length, {0, 1, true}};
inline constexpr input::Quantity kRatio{input::Dimension::number, {0, 1}};
inline constexpr input::Quantity kShare{input::Dimension::number, {0, 1, true, true}};
inline constexpr input::Quantity kBound{input::Dimension::number, {}};

}  // namespace lcs::scenario
