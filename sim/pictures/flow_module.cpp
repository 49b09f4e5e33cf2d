/// \file
/// The library that `optical_flow()` loads.
#include "sim/pictures/media.h"

extern "C" const lcs::sim::OpticalFlow lcs_flow_functions;
const lcs::sim::OpticalFlow lcs_flow_functions = {
    &cv::buildOpticalFlowPyramid,
    &cv::calcOpticalFlowPyrLK,
    &cv::DISOpticalFlow::create,
};
