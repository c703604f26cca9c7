// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/state_message.h"

#include <string>

#include <fmt/format.h>

#include "coordinator/config/message_to_statements.h"
#include "coordinator/config/named.h"
#include "coordinator/config/section_readers.h"
#include "coordinator/config/statement_list.h"
#include "eyrie/v1/configuration.pb.h"
#include "fabric/status.h"

namespace eyrie::config {
namespace {

using Pixels = google::protobuf::RepeatedField<std::int32_t>;

void set(const std::optional<fabric::Vec2>& value, Pixels& pixels) {
    if (!value)
        return;
    pixels.Add(static_cast<std::int32_t>(value->x));
    pixels.Add(static_cast<std::int32_t>(value->y));
}

absl::Status read(const Pixels& pixels, std::string_view field,
                  std::optional<fabric::Vec2>& target) {
    if (pixels.empty())
        return absl::OkStatus();
    if (pixels.size() != 2)
        return absl::InvalidArgumentError(
            fmt::format("{} has {} numbers; it must have 2", field, pixels.size()));
    target = fabric::Vec2(pixels[0], pixels[1]);
    return absl::OkStatus();
}

absl::Status readSurface(const google::protobuf::Message& message, bool isWall,
                         std::optional<Surface>& surface) {
    Findings findings;
    Statement block{isWall ? "wall" : "projection"};
    block.form = Statement::Form::Block;
    block.statements = toStatements(message, findings);
    ValueReader reader(findings);
    surface = isWall ? readWall(block, reader) : readProjection(block, reader);
    if (!findings.hasErrors())
        return absl::OkStatus();
    return absl::InvalidArgumentError(findings.all().front().message);
}

/// 0 is as configured, as proto3's enumerations begin with what is absent.
template <typename T>
absl::Status readEnum(int number, int most, std::string_view field, std::optional<T>& target) {
    if (number < 0 || number > most)
        return absl::InvalidArgumentError(
            fmt::format("{} is {}, which this version does not know", field, number));
    if (number > 0)
        target = static_cast<T>(number - 1);
    return absl::OkStatus();
}

/// `field`: what errors call the list.
template <typename Messages>
absl::Status changeAll(const Messages& messages, std::string_view field,
                       const Configuration& configuration, ConfigurationState& state) {
    for (int i = 0; i < messages.size(); ++i)
        RETURN_IF_ERROR(fabric::withContext(change(messages[i], configuration, state),
                                            fmt::format("{}[{}]", field, i)));
    return absl::OkStatus();
}

}  // namespace

v1::EqualizerTuning toMessage(const EqualizerTuning& state) {
    v1::EqualizerTuning message;
    if (state.isOn)
        message.set_on(*state.isOn);
    if (state.isFrozen)
        message.set_frozen(*state.isFrozen);
    if (state.mode)
        message.set_mode(static_cast<v1::SplitMode>(static_cast<int>(*state.mode) + 1));
    if (state.damping)
        message.set_damping(*state.damping);
    set(state.boundaryPixels, *message.mutable_boundary());
    if (state.boundaryRange)
        message.set_boundary_range(*state.boundaryRange);
    set(state.resistancePixels, *message.mutable_resistance());
    if (state.resistanceRange)
        message.set_resistance_range(*state.resistanceRange);
    if (state.assembleOnlyLimit)
        message.set_assemble_only_limit(*state.assembleOnlyLimit);
    if (state.framerate)
        message.set_framerate(*state.framerate);
    set(state.tileSize, *message.mutable_tile_size());
    if (state.tileChunk)
        message.set_tile_chunk(*state.tileChunk);
    return message;
}

v1::Head toMessage(const fabric::Mat4& roomFromHead) {
    v1::Head message;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
            message.add_room_from_head(roomFromHead[column][row]);
    return message;
}

v1::ViewSetting toMessage(const ViewState& state) {
    v1::ViewSetting message;
    if (state.isStereo)
        message.set_mode(*state.isStereo ? v1::VIEW_MODE_STEREO : v1::VIEW_MODE_MONO);
    if (state.stereoMode)
        message.set_stereo_mode(
            static_cast<v1::StereoMode>(static_cast<int>(*state.stereoMode) + 1));
    message.set_model_unit(state.modelUnit);
    if (!state.surface)
        return message;
    StatementList list;
    writeSurface(*state.surface, list);
    const std::vector<Statement> statements = list.take();
    if (statements.empty())
        message.set_no_surface(true);
    fill(statements, message);
    return message;
}

v1::ObserverSetting toMessage(const ObserverState& state) {
    v1::ObserverSetting message;
    if (state.eyeBase)
        message.set_eye_base(*state.eyeBase);
    if (state.focusDistance)
        message.set_focus_distance(*state.focusDistance);
    if (state.focusMode)
        message.set_focus_mode(static_cast<v1::FocusMode>(static_cast<int>(*state.focusMode) + 1));
    return message;
}

v1::ConfigurationState toMessage(const Configuration& configuration,
                                 const ConfigurationState& state) {
    v1::ConfigurationState message;
    for (std::size_t i = 0; i < state.layouts.size(); ++i) {
        v1::LayoutSwitch& shown = *message.add_layouts();
        shown.set_canvas(called(configuration.canvases, i));
        shown.set_layout(state.layouts[i] ? called(configuration.layouts, *state.layouts[i])
                                          : "OFF");
    }
    for (std::size_t i = 0; i < state.equalizers.size(); ++i) {
        *message.add_equalizers() = toMessage(state.equalizers[i]);
        message.mutable_equalizers()->rbegin()->set_equalizer(static_cast<std::int32_t>(i));
    }
    for (std::size_t i = 0; i < state.heads.size(); ++i) {
        *message.add_heads() = toMessage(state.heads[i]);
        message.mutable_heads()->rbegin()->set_observer(called(configuration.observers, i));
    }
    for (std::size_t i = 0; i < state.views.size(); ++i)
        for (std::size_t j = 0; j < state.views[i].size(); ++j) {
            v1::ViewSetting& view = *message.add_views() = toMessage(state.views[i][j]);
            view.set_layout(called(configuration.layouts, i));
            view.set_view(called(configuration.layouts[i].views, j));
        }
    for (std::size_t i = 0; i < state.observers.size(); ++i) {
        v1::ObserverSetting& observer = *message.add_observers() = toMessage(state.observers[i]);
        observer.set_observer(called(configuration.observers, i));
    }
    return message;
}

absl::StatusOr<EqualizerTuning> fromMessage(const v1::EqualizerTuning& message) {
    EqualizerTuning settings;
    if (message.has_on())
        settings.isOn = message.on();
    if (message.has_frozen())
        settings.isFrozen = message.frozen();
    RETURN_IF_ERROR(readEnum(message.mode(), v1::SPLIT_MODE_VERTICAL, "mode", settings.mode));
    RETURN_IF_ERROR(read(message.boundary(), "boundary", settings.boundaryPixels));
    RETURN_IF_ERROR(read(message.resistance(), "resistance", settings.resistancePixels));
    RETURN_IF_ERROR(read(message.tile_size(), "tileSize", settings.tileSize));
    if (message.has_damping())
        settings.damping = message.damping();
    if (message.has_boundary_range())
        settings.boundaryRange = message.boundary_range();
    if (message.has_resistance_range())
        settings.resistanceRange = message.resistance_range();
    if (message.has_assemble_only_limit())
        settings.assembleOnlyLimit = message.assemble_only_limit();
    if (message.has_framerate())
        settings.framerate = message.framerate();
    if (message.has_tile_chunk())
        settings.tileChunk = message.tile_chunk();
    return settings;
}

absl::StatusOr<fabric::Mat4> fromMessage(const v1::Head& message) {
    if (message.room_from_head_size() != 12)
        return absl::InvalidArgumentError(fmt::format(
            "roomFromHead has {} numbers; it must have 12", message.room_from_head_size()));
    fabric::Mat4 roomFromHead(1);
    for (int i = 0; i < 12; ++i) roomFromHead[i % 4][i / 4] = message.room_from_head(i);
    return roomFromHead;
}

absl::StatusOr<ViewState> fromMessage(const v1::ViewSetting& message) {
    ViewState settings;
    RETURN_IF_ERROR(readEnum(message.mode(), v1::VIEW_MODE_STEREO, "mode", settings.isStereo));
    RETURN_IF_ERROR(readEnum(message.stereo_mode(), v1::STEREO_MODE_PASSIVE, "stereoMode",
                             settings.stereoMode));
    if (message.has_model_unit())
        settings.modelUnit = message.model_unit();
    if (message.has_wall())
        RETURN_IF_ERROR(readSurface(message.wall(), true, settings.surface));
    if (message.has_projection())
        RETURN_IF_ERROR(readSurface(message.projection(), false, settings.surface));
    if (message.no_surface())
        settings.surface = Surface{};
    return settings;
}

absl::StatusOr<ObserverState> fromMessage(const v1::ObserverSetting& message) {
    ObserverState settings;
    if (message.has_eye_base())
        settings.eyeBase = message.eye_base();
    if (message.has_focus_distance())
        settings.focusDistance = message.focus_distance();
    RETURN_IF_ERROR(readEnum(message.focus_mode(), v1::FOCUS_MODE_RELATIVE_TO_OBSERVER, "focusMode",
                             settings.focusMode));
    return settings;
}

absl::Status change(const v1::LayoutSwitch& message, const Configuration& configuration,
                    ConfigurationState& state) {
    return switchLayout(configuration, state, message.canvas(), message.layout());
}

absl::Status change(const v1::EqualizerTuning& message, const Configuration& configuration,
                    ConfigurationState& state) {
    if (message.equalizer() < 0)
        return absl::NotFoundError(fmt::format("there is no equalizer {}", message.equalizer()));
    const absl::StatusOr<EqualizerTuning> tuning = fromMessage(message);
    if (!tuning.ok())
        return fabric::withContext(tuning.status(),
                                   fmt::format("equalizer {}", message.equalizer()));
    return tuneEqualizer(configuration, state, static_cast<std::size_t>(message.equalizer()),
                         *tuning);
}

absl::Status change(const v1::Head& message, const Configuration& configuration,
                    ConfigurationState& state) {
    ASSIGN_OR_RETURN(const fabric::Mat4 roomFromHead, fromMessage(message));
    return setHead(configuration, state, message.observer(), roomFromHead);
}

absl::Status change(const v1::ViewSetting& message, const Configuration& configuration,
                    ConfigurationState& state) {
    ASSIGN_OR_RETURN(const ViewState settings, fromMessage(message));
    return setView(configuration, state, message.layout(), message.view(), settings);
}

absl::Status change(const v1::ObserverSetting& message, const Configuration& configuration,
                    ConfigurationState& state) {
    ASSIGN_OR_RETURN(const ObserverState settings, fromMessage(message));
    return setObserver(configuration, state, message.observer(), settings);
}

absl::Status change(const v1::ConfigurationState& message, const Configuration& configuration,
                    ConfigurationState& state) {
    ConfigurationState changed = state;
    RETURN_IF_ERROR(changeAll(message.layouts(), "layouts", configuration, changed));
    RETURN_IF_ERROR(changeAll(message.equalizers(), "equalizers", configuration, changed));
    RETURN_IF_ERROR(changeAll(message.heads(), "heads", configuration, changed));
    RETURN_IF_ERROR(changeAll(message.views(), "views", configuration, changed));
    RETURN_IF_ERROR(changeAll(message.observers(), "observers", configuration, changed));
    state = std::move(changed);
    return absl::OkStatus();
}

}  // namespace eyrie::config
