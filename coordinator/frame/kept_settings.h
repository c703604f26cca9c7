// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include <absl/status/status.h>

#include "coordinator/config/state.h"

namespace eyrie::coordinator {

class ActiveConfiguration;

/// What was set while a configuration was at work, by the names of what it was set for: one that
/// takes its place goes on with what it has of that, and what it has not stays kept for a later
/// one. Which layouts are shown is no part of it.
struct KeptSettings {
    std::map<std::string, config::EqualizerTuning> equalizers;
    std::map<std::string, config::ObserverState> observers;
    std::map<std::string, fabric::Mat4> heads;                               ///< of observers
    std::map<std::pair<std::string, std::string>, config::ViewState> views;  ///< layout and view

    void keep(const ActiveConfiguration& active);

    /// Why some of it cannot be set: NotFound where the configuration has no such thing,
    /// InvalidArgument where it has another of that name. The rest is set, or, where it cannot be
    /// shown, nothing.
    std::vector<absl::Status> restore(ActiveConfiguration& active) const;

    bool operator==(const KeptSettings&) const = default;
};

}  // namespace eyrie::coordinator
