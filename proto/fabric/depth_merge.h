// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fabric/image.h"

namespace eyrie::fabric {

/// Which of two equally near pixels stays.
enum class Ties { Target, Source };

/// Sort-last compositing of opaque images: per pixel the nearer one stays (the greater reversed
/// depth). On equal depth `target` keeps its pixel, so merge in ascending order of range: the
/// result then depends on the ranges alone, never on the order in which images arrived. Where
/// `source` is of the range before, Ties::Source says the same the other way round.
///
/// Associative for any order of grouping that keeps that sequence.
/// Preconditions: both have depth; target.area contains source.area.
void mergeDepth(const ImageView& source, Image& target, Ties ties = Ties::Target);

}  // namespace eyrie::fabric
