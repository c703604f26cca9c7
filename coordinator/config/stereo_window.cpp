// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/stereo_window.h"

#include <string_view>

namespace eyrie::config {
namespace {

/// The window's own setting, else that of all windows; null where neither is written.
const Attribute* settingOf(const Configuration& configuration, const Window& window,
                           std::string_view own, std::string_view global) {
    const Attribute* const setting = find(window.attributes, own);
    return setting != nullptr ? setting : find(configuration.globals, global);
}

bool isWord(const Attribute* setting, std::string_view word) {
    const auto* const words =
        setting != nullptr ? std::get_if<Attribute::Words>(&setting->value) : nullptr;
    return words != nullptr && words->words.size() == 1 && words->words.front() == word;
}

/// ON, or the number that it is.
bool isOn(const Attribute* setting) {
    const auto* const number =
        setting != nullptr ? std::get_if<std::int64_t>(&setting->value) : nullptr;
    return isWord(setting, "ON") || (number != nullptr && *number == 1);
}

}  // namespace

bool isOfStereoWindow(const Configuration& configuration, const ChannelIndex& index) {
    const Window& window = configuration.nodes[index.node].pipes[index.pipe].windows[index.window];
    if (!isOn(settingOf(configuration, window, "hint_stereo", "EQ_WINDOW_IATTR_HINT_STEREO")))
        return false;
    const Attribute* const drawable =
        settingOf(configuration, window, "hint_drawable", "EQ_WINDOW_IATTR_HINT_DRAWABLE");
    return !isWord(drawable, "FBO") && !isWord(drawable, "pbuffer") &&
           window.channels[index.channel].drawables.empty();
}

}  // namespace eyrie::config
