// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <utility>

#include <absl/status/statusor.h>

#include "fabric/status.h"
#include "renderer/effects/effect_watch.h"

namespace eyrie::effects {

/// The variants of one effect, each compiled when a frame first needs it. `Effect` is a class that
/// effect_compiler generated. Belongs to the GL thread.
template <typename Effect>
class EffectVariants {
public:
    using Variant = typename Effect::Variant;

    /// With a folder, its files replace the built-in ones whenever they change and are good.
    explicit EffectVariants(const std::optional<std::filesystem::path>& folder = watchedFolder()) {
        if (folder)
            watch_.emplace(*folder, Effect::builtIn());
    }

    /// The program for `variant`, until the next reloadChanged.
    absl::StatusOr<const Effect*> find(const Variant& variant) {
        if (const auto known = programs_.find(variant); known != programs_.end())
            return &known->second;
        absl::StatusOr<Effect> program = Effect::create(variant, source());
        if (!program.ok() && edited_) {
            reportReload(Effect::builtIn(), program.status());
            program = Effect::create(variant);
        }
        if (!program.ok())
            return program.status();
        return &programs_.emplace(variant, *std::move(program)).first->second;
    }

    /// To be called between frames. Puts an edited effect in place of the one before when every
    /// variant in use compiles, and otherwise logs why and changes nothing.
    void reloadChanged(EffectWatch::Clock::time_point now) {
        if (!watch_)
            return;
        if (auto changed = watch_->changed(now))
            reportReload(Effect::builtIn(),
                         changed->ok() ? replace(**std::move(changed)) : changed->status());
    }

private:
    const EffectSource& source() const { return edited_ ? *edited_ : Effect::builtIn(); }

    absl::Status replace(EffectSource edited) {
        if (programs_.empty())
            RETURN_IF_ERROR(Effect::create(Variant(), edited).status());
        std::map<Variant, Effect> programs;
        for (const auto& [variant, replaced] : programs_) {
            ASSIGN_OR_RETURN(Effect program, Effect::create(variant, edited));
            programs.emplace(variant, std::move(program));
        }
        programs_ = std::move(programs);
        edited_ = std::move(edited);
        return absl::OkStatus();
    }

    std::map<Variant, Effect> programs_;
    std::optional<EffectWatch> watch_;
    std::optional<EffectSource> edited_;  ///< none: the built-in one
};

}  // namespace eyrie::effects
