// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "coordinator/compound/decompose.h"

namespace eyrie::cli {

/// What --compound takes.
inline const std::map<std::string, coordinator::Decomposition>& compoundNames() {
    static const std::map<std::string, coordinator::Decomposition> names = {
        {"2D", coordinator::Decomposition::TwoD}, {"DB", coordinator::Decomposition::Db}};
    return names;
}

}  // namespace eyrie::cli
