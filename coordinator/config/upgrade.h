// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coordinator/config/configuration.h"

namespace eyrie::config {

/// Brings what was written for an Equalizer before 1.2 to what 1.2 has, as Equalizer does when it
/// opens it. Done twice it changes nothing more.
///
/// - Where there is no canvas, whatever the version, a tree of compounds that draws straight into a
///   channel gets a canvas of one segment and a layout of one view, which has the compound's wall.
///   Trees of one channel and wall share them.
/// - Where such trees have a group above them, they are segments of one canvas, which has the
///   group's wall; each shows its share, the tree's viewport, in the whole of its channel.
/// - In those, and in files of 1.0 or of no version, a view is stereo where the trees that show it,
///   or groups above them, have eyes LEFT or RIGHT and not CYCLOP, which they get. Segments show
///   the eyes of their trees and CYCLOP; those that say theirs keep them.
/// - Where no observer is, there is one of usual values, and each view has it.
///
/// That a view without compound is drawn plainly holds for all versions, and is resolve()'s.
void upgrade(Configuration& configuration);

}  // namespace eyrie::config
