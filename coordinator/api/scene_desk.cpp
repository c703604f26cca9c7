// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/scene_desk.h"

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <google/protobuf/util/message_differencer.h>

#include "coordinator/api/data_desk.h"
#include "coordinator/api/field_names.h"
#include "coordinator/api/quotas.h"
#include "coordinator/api/state_file.h"
#include "eyrie/v1/kept_state.pb.h"
#include "fabric/log.h"
#include "fabric/scene_reach.h"
#include "fabric/shown_name.h"
#include "fabric/status.h"
#include "wire/scene.h"
#include "wire/scene_info.h"

namespace eyrie::api {
namespace {

using fabric::ObjectKind;

absl::Status atObject(int index, const absl::Status& status) {
    return fabric::withContext(status, fmt::format("scene.objects[{}]", index));
}

/// Of a file that is none of `kind`.
absl::Status namedAsOther(const std::string& name, ObjectKind kind) {
    const bool isTerrain = kind == ObjectKind::Terrain;
    return absl::InvalidArgumentError(fmt::format("'{}' is a {}, and named as a {}", name,
                                                  isTerrain ? "mesh" : "terrain",
                                                  isTerrain ? "terrain" : "mesh"));
}

std::string& pathIn(v1::SceneObject& object) {
    return object.has_terrain() ? *object.mutable_terrain() : *object.mutable_mesh();
}

/// Of a file below `folder`, whose path has no links; empty where it lies elsewhere. The command
/// line may have named it by way of links.
std::string nameBelow(const std::filesystem::path& folder, const std::filesystem::path& path) {
    std::error_code error;
    std::filesystem::path name = path.lexically_relative(folder);
    if (path.is_absolute() && !name.empty() && *name.begin() == "..")
        name = (std::filesystem::weakly_canonical(path.parent_path(), error) / path.filename())
                   .lexically_relative(folder);
    return name.empty() || *name.begin() == ".." ? "" : name.string();
}

v1::KeptScene keptScene(const fabric::Scene& asNamed, v1::Scene scene) {
    v1::KeptScene kept;
    *kept.mutable_command_line() = wire::toMessage(asNamed);
    *kept.mutable_scene() = std::move(scene);
    return kept;
}

}  // namespace

SceneDesk::SceneDesk(const std::optional<access::DataFolder>& folder, DataDesk& data,
                     const QuotaKeeper& quotas, coordinator::FrameSource& frames,
                     std::function<void(fabric::Scene)> setScene, StateFile* state)
    : folder_(folder),
      data_(data),
      quotas_(quotas),
      frames_(frames),
      setScene_(std::move(setScene)),
      state_(state) {}

void SceneDesk::begin(fabric::Scene scene, fabric::Scene asNamed) {
    {
        const std::lock_guard lock(mutex_);
        for (const fabric::SceneObject& object : scene.objects)
            allowed_.emplace(object.path, object.kind);
        commandLine_ = scene;
        asTold_ = wire::fromMessage(wire::toMessage(scene)).value_or(scene);
        asNamed_ = asNamed;
    }
    const bool hasKept = state_ != nullptr && state_->scene().has_scene();
    const absl::Status shown = hasKept ? showKept(scene, asNamed) : absl::NotFoundError("");
    if (shown.ok())
        return;
    if (hasKept)
        spdlog::warn("{} is shown, and not the scene that was set: {}",
                     scene.objects.empty() ? "nothing" : "the scene of the command line",
                     std::string_view(shown.message().data(), shown.message().size()));
    setScene_(std::move(scene));
}

/// Earlier versions kept it for the command line's scene as that was shown.
absl::Status SceneDesk::showKept(const fabric::Scene& commandLine,
                                 const fabric::Scene& asNamed) const {
    const v1::KeptScene kept = state_->scene();
    const auto isOf = [&](const fabric::Scene& scene) {
        return google::protobuf::util::MessageDifferencer::Equals(kept.command_line(),
                                                                  wire::toMessage(scene));
    };
    if (!isOf(asNamed) && !isOf(commandLine))
        return absl::FailedPreconditionError("that was in place of another");
    ASSIGN_OR_RETURN(fabric::Scene scene, resolved(kept.scene(), {}));
    spdlog::info("the scene that was set in place of the command line's is shown");
    setScene_(std::move(scene));
    return absl::OkStatus();
}

v1::Scene SceneDesk::scene() const { return named(frames_.status().scene); }

v1::Scene SceneDesk::sceneForAnybody() const {
    v1::Scene message = scene();
    for (v1::SceneObject& object : *message.mutable_objects()) {
        std::string& path = pathIn(object);
        path = fabric::shownName(path);
    }
    return message;
}

v1::Scene SceneDesk::named(const fabric::Scene& scene) const {
    v1::Scene message = wire::toMessage(scene);
    for (v1::SceneObject& object : *message.mutable_objects()) {
        std::string& path = pathIn(object);
        if (!folder_)
            continue;
        if (const std::string name = nameBelow(folder_->path(), path); !name.empty())
            path = name;
    }
    return message;
}

absl::StatusOr<std::string> SceneDesk::pathOf(const std::string& name, ObjectKind kind) const {
    const bool isTerrain = kind == ObjectKind::Terrain;
    {
        const std::lock_guard lock(mutex_);
        if (allowed_.contains({name, kind}))
            return name;
        if (allowed_.contains({name, isTerrain ? ObjectKind::Mesh : ObjectKind::Terrain}))
            return namedAsOther(name, kind);
    }
    if (!folder_)
        return absl::FailedPreconditionError(
            "the server has no data folder, and draws what it was started with; start it with "
            "--data DIR");
    ASSIGN_OR_RETURN(const std::filesystem::path path, folder_->existing(name));
    const char* const ending = isTerrain ? ".eyt" : ".eym";
    if (path.extension() == (isTerrain ? ".eym" : ".eyt"))
        return namedAsOther(name, kind);
    if (path.extension() != ending)
        return absl::InvalidArgumentError(
            fmt::format("'{}' does not end in {}; import it first", name, ending));
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
        return absl::NotFoundError(fmt::format("'{}' is no file of the data folder", name));
    return path.string();
}

absl::Status SceneDesk::checkSize(const std::vector<NamedFile>& files,
                                  const std::stop_token& stop) const {
    const Quotas& most = quotas_.most();
    std::uint64_t bytes = 0;
    for (const NamedFile& file : files) {
        std::error_code error;
        const std::uintmax_t size = std::filesystem::file_size(folder_->path() / file.name, error);
        bytes += error ? 0 : size;
    }
    if (bytes > most.sceneBytes)
        return absl::InvalidArgumentError(
            fmt::format("scene.objects have files of {} bytes; at most {} are drawn at a time",
                        bytes, most.sceneBytes));
    std::uint64_t triangles = 0;
    for (const NamedFile& file : files) {
        const absl::StatusOr<v1::DataSet> set = data_.look(file.name, stop);
        if (absl::IsFailedPrecondition(set.status()))
            return atObject(file.object, set.status());
        RETURN_IF_ERROR(set.status());
        triangles += static_cast<std::uint64_t>(std::max<std::int64_t>(0, set->triangles()));
    }
    if (most.sceneTriangles == 0 || triangles <= most.sceneTriangles)
        return absl::OkStatus();
    return absl::InvalidArgumentError(
        fmt::format("scene.objects have {} triangles; at most {} are drawn at a time", triangles,
                    most.sceneTriangles));
}

absl::Status SceneDesk::checkReach(const std::vector<NamedFile>& files, const fabric::Scene& scene,
                                   const std::stop_token& stop) const {
    for (const NamedFile& file : files) {
        ASSIGN_OR_RETURN(const v1::DataSet set, data_.look(file.name, stop));
        const absl::StatusOr<fabric::Box> bounds = wire::fromMessage(set.bounds());
        const fabric::SceneObject& object = scene.objects[static_cast<std::size_t>(file.object)];
        if (bounds.ok())  // else it has none
            RETURN_IF_ERROR(atObject(
                file.object,
                fabric::checkReach(object, fabric::transformed(*bounds, object.worldFromObject))));
    }
    return absl::OkStatus();
}

absl::StatusOr<fabric::Scene> SceneDesk::resolved(v1::Scene message,
                                                  const std::stop_token& stop) const {
    const int most = quotas_.most().sceneObjects;
    if (message.objects_size() == 0)
        return absl::InvalidArgumentError(
            fmt::format("scene.objects is empty; it must have 1 to {}", most));
    if (message.objects_size() > most)
        return quotas_.counted(observe::Quota::Scene,
                               absl::InvalidArgumentError(
                                   fmt::format("scene.objects has {} objects; it must have 1 to {}",
                                               message.objects_size(), most)));
    std::vector<NamedFile> files;
    for (int i = 0; i < message.objects_size(); ++i) {
        v1::SceneObject& object = *message.mutable_objects(i);
        if (object.imagery_size() > 0)
            return atObject(i, absl::InvalidArgumentError(
                                   "imagery is given; import it with its terrain first"));
        if (object.data_case() == v1::SceneObject::DATA_NOT_SET)
            return atObject(
                i, absl::InvalidArgumentError("there is neither terrain nor mesh; name a file"));
        std::string& name = pathIn(object);
        if (object.name().empty())
            object.set_name(std::filesystem::path(fabric::shownName(name)).filename().string());
        absl::StatusOr<std::string> path =
            pathOf(name, object.has_terrain() ? ObjectKind::Terrain : ObjectKind::Mesh);
        if (!path.ok())
            return atObject(i, path.status());
        if (*path != name)
            files.push_back(
                {i, std::filesystem::path(*path).lexically_relative(folder_->path()).string()});
        name = *std::move(path);
    }
    if (absl::Status status = checkSize(files, stop); absl::IsInvalidArgument(status))
        return quotas_.counted(observe::Quota::Scene, status);
    else if (!status.ok())
        return status;
    absl::StatusOr<fabric::Scene> scene = wire::fromMessage(message);
    RETURN_IF_ERROR(inRequest(scene.status(), "scene.", *v1::Scene::descriptor()));
    RETURN_IF_ERROR(checkReach(files, *scene, stop));
    return scene;
}

absl::Status SceneDesk::show(v1::Scene message, const std::stop_token& stop) {
    ASSIGN_OR_RETURN(fabric::Scene scene, resolved(std::move(message), stop));
    const std::lock_guard lock(mutex_);  // of several the last is shown, and kept
    setScene_(scene);
    if (state_ == nullptr)
        return absl::OkStatus();
    // As it is told: the command line may have gone by links.
    v1::Scene told = named(scene);
    const auto isToldAs = [&](const fabric::Scene& other) {
        return google::protobuf::util::MessageDifferencer::Equals(told, named(other));
    };
    if (isToldAs(commandLine_) || isToldAs(asTold_))
        state_->forgetScene();
    else
        state_->keep(keptScene(asNamed_, std::move(told)));
    return absl::OkStatus();
}

}  // namespace eyrie::api
