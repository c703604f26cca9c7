// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace eyrie::import {

/// Colours of OBJ and OFF, and of PLY those of real numbers, reach to 1 or to 255, and the files do
/// not say to which: to 255 where a number is above this one, as many of those that reach to 1 are
/// a little above it.
constexpr double kMostOfFractions = 2;

/// Colours of 16 bits reach to 65,535, unless no number is above this one: a mesh of them would be
/// black, and programs write the bytes that they have into numbers that are wider.
constexpr double kMostOfBytes = 255;

/// For TriangleMesh::notes, where they reach to 255.
constexpr const char* kColoursAreBytes = "vertices' colours are taken for numbers of 0 to 255";

}  // namespace eyrie::import
