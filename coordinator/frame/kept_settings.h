// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <utility>

#include <absl/status/status.h>

#include "coordinator/config/state.h"

namespace eyrie::coordinator {

class ActiveConfiguration;

/// What was set while a configuration was at work, by the names of what it was set for: one that
/// takes its place goes on with what it has of that, and what it has not stays kept for a later
/// one. Which layouts are shown is no part of it.
class KeptSettings {
public:
    void keep(const ActiveConfiguration& active);

    /// Errors: those of ActiveConfiguration::become.
    absl::Status restore(ActiveConfiguration& active) const;

private:
    std::map<std::string, config::EqualizerTuning> equalizers_;
    std::map<std::string, config::ObserverState> observers_;
    std::map<std::string, fabric::Mat4> heads_;                               ///< of observers
    std::map<std::pair<std::string, std::string>, config::ViewState> views_;  ///< layout and view
};

}  // namespace eyrie::coordinator
