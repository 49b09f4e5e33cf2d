#include "sim/camera/photograph.h"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "sim/camera/linear_light.h"
#include "sim/pictures/media.h"
#include "sim/pictures/picture_file.h"

namespace lcs::sim {

Photographer::Photographer(const scenario::Image& image, const Optics& camera, double rate_hz,
                           std::uint64_t scenario_seed)
    : blur_px_(image.blur_px),
      jpeg_quality_(image.jpeg_quality),
      rate_hz_(rate_hz),
      illumination_(image, camera),
      sensor_(image, scenario_seed) {
  if (image.rain)
    rain_.emplace(*image.rain, image.exposure_s, camera.lens().pinhole(), scenario_seed);
}

void Photographer::develop(cv::Mat3b& picture, const cv::Mat1f& depth_m, int k) {
  cv::Mat3f light = to_linear(picture);
  illumination_.light(light, depth_m);
  if (rain_) {
    rain_->add_streaks(light, depth_m, illumination_, k);
    rain_->look_through_drops(light, k / rate_hz_);
  }
  if (blur_px_ > 0) cv::GaussianBlur(light, light, {}, blur_px_);
  sensor_.expose(light, k);
  to_codes(light, picture);
  if (jpeg_quality_) {
    media().imdecode(encode_jpeg(picture, *jpeg_quality_), cv::IMREAD_COLOR).copyTo(picture);
  }
}

}  // namespace lcs::sim
