#include "scenarios/load_image.h"

#include "scenarios/quantities.h"

namespace lcs::scenario {
namespace {

constexpr int kMostLensDrops = 500;
constexpr int kBestJpeg = 100;

Image::Headlights read_headlights(Reader reader) {
  Image::Headlights headlights;
  reader.require("intensity");
  reader.read("intensity", kIntensity, headlights.intensity_cd);
  reader.read("beam", kBeam, headlights.beam_rad);
  reader.finish();
  return headlights;
}

Image::Rain read_rain(Reader reader) {
  Image::Rain rain;
  reader.read("rate", kRainRate, rain.rate_mmph);
  reader.read("lens_drops", 0, kMostLensDrops, rain.lens_drops);
  reader.read("drop_life", kDropLife, rain.drop_life_s);
  reader.finish();
  return rain;
}

Image::Noise read_noise(Reader reader) {
  Image::Noise noise;
  reader.read("full_well", kFullWell, noise.full_well_e);
  reader.read("read", kElectrons, noise.read_e);
  reader.finish();
  return noise;
}

}  // namespace

Image read_image(Reader reader) {
  Image image;
  const auto section = [&](const char* key, auto&& read, auto& out) {
    if (const Value* value = reader.find(key)) out = read(Reader(*value, reader.path_of(key)));
  };
  reader.read("light", kIlluminance, image.light_lx);
  section("headlights", read_headlights, image.headlights);
  reader.read("visibility", kDistance, image.visibility_m);
  section("rain", read_rain, image.rain);
  reader.read("blur", kBlur, image.blur_px);
  reader.read("exposure", kExposure, image.exposure_s);
  reader.read("gain", kGain, image.gain);
  if (const Value* noise = reader.find("noise"); noise && noise->text == "none") {
    image.noise.reset();
  } else {
    section("noise", read_noise, image.noise);
  }
  if (reader.find("jpeg")) reader.read("jpeg", 1, kBestJpeg, image.jpeg_quality.emplace());
  reader.finish();
  return image;
}

Ground read_ground(Reader reader) {
  Ground ground;
  reader.read("roughness", kRoughness, ground.roughness_m);
  reader.read("wavelength", kSize, ground.wavelength_m);
  reader.read("centre", kPosition, ground.centre_m);
  reader.read("size", kSize, ground.size_m);
  reader.finish();
  return ground;
}

}  // namespace lcs::scenario
