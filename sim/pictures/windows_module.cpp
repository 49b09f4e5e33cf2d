/// \file
/// The library that `windows()` loads.
#include "sim/pictures/media.h"

extern "C" const lcs::sim::Windows lcs_windows_functions;
const lcs::sim::Windows lcs_windows_functions = {
    &cv::namedWindow,
    &cv::destroyAllWindows,
    &cv::waitKey,
    &cv::getWindowProperty,
    [](const cv::String& title, const cv::Size& size_px) { cv::resizeWindow(title, size_px); },
    &cv::imshow,
};
