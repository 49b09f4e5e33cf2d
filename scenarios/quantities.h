/// \file
/// Accepted ranges of a scenario's numbers. The outer bounds are generous: they catch wrong units
/// (km for m) without limiting large experiments.
#pragma once

#include "scenarios/reader.h"

namespace lcs::scenario {

inline constexpr Quantity kPosition{Dimension::length, {-10000, 10000}};
inline constexpr Quantity kSize{Dimension::length, {0, 100, true}};
inline constexpr Quantity kDistance{Dimension::length, {0, 10000, true}};
inline constexpr Quantity kTime{Dimension::time, {0, 100000}};
inline constexpr Quantity kDuration{Dimension::time, {0, 100000, true}};
inline constexpr Quantity kSpeed{Dimension::speed, {0, 100}};
inline constexpr Quantity kSignedSpeed{Dimension::speed, {-100, 100}};
inline constexpr Quantity kAcceleration{Dimension::acceleration, {-100, 100}};
inline constexpr Quantity kAngle{Dimension::angle, {-360, 360}};
inline constexpr Quantity kFieldOfView{Dimension::angle, {0, 180, true, true}};
inline constexpr Quantity kFocal{Dimension::pixels, {1, 1e6}};
inline constexpr Quantity kInPicture{Dimension::pixels, {-100000, 100000}};
inline constexpr Quantity kCoefficient{Dimension::number, {-1000, 1000}};
inline constexpr Quantity kAngularRate{Dimension::angular_rate, {-720, 720}};
/// Of the camera. At the lowest rate, ten seconds of physics lie between two frames.
inline constexpr Quantity kCameraRate{Dimension::frequency, {0.1, 1000}};
inline constexpr Quantity kSensorRate{Dimension::frequency, {0, 10000, true}};
inline constexpr Quantity kNoiseDensity{Dimension::number, {0, 1000}};
inline constexpr Quantity kIlluminance{Dimension::illuminance, {0, 200000}};
inline constexpr Quantity kIntensity{Dimension::intensity, {0, 1000000}};
inline constexpr Quantity kBeam{Dimension::angle, {0, 90, true}};
inline constexpr Quantity kBlur{Dimension::number, {0, 50}};
inline constexpr Quantity kDropLife{Dimension::time, {0.01, 100000}};
inline constexpr Quantity kRainRate{Dimension::number, {0, 200}};
inline constexpr Quantity kExposure{Dimension::time, {0, 10, true}};
inline constexpr Quantity kGain{Dimension::number, {0, 1000, true}};
inline constexpr Quantity kElectrons{Dimension::number, {0, 1000000}};
inline constexpr Quantity kFullWell{Dimension::number, {0, 1000000, true}};
inline constexpr Quantity kYawNoise{Dimension::angular_rate, {0, 720}};
inline constexpr Quantity kTurnOnRate{Dimension::angular_rate, {0, 720}};
inline constexpr Quantity kTurnOnAcceleration{Dimension::acceleration, {0, 100}};
inline constexpr Quantity kRoughness{Dimension::length, {0, 1, true}};
inline constexpr Quantity kRatio{Dimension::number, {0, 1}};
inline constexpr Quantity kBound{Dimension::number, {}};

}  // namespace lcs::scenario
