/// \file
/// The loops of `vectors.h`, for machines with AVX2.
#pragma once

#include "filter/vectors/vectors.h"

namespace lcs::avx2 {

const Loops& loops();

}  // namespace lcs::avx2
