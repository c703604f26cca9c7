// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "fabric/camera.h"

namespace eyrie::coordinator {

/// Tells cuts from movements: a view that differs from the last one by much, and by far more than
/// the last ones differed from each other. What was learned of those says little of it.
class ViewChange {
public:
    /// Whether `camera` is a cut from the last view that was followed. The first view is one.
    bool isCut(const fabric::Camera& camera) const;

    void follow(const fabric::Camera& camera);

private:
    std::optional<fabric::Camera> last_;
    double usual_ = 0;  ///< change from one view to the next, the latest counting most
};

}  // namespace eyrie::coordinator
