// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/state_file.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>
#include <google/protobuf/util/message_differencer.h>

#include "coordinator/api/kept_messages.h"
#include "coordinator/api/replace_file.h"
#include "eyrie/v1/kept_state.pb.h"
#include "fabric/log.h"
#include "fabric/status.h"
#include "wire/json.h"
#include "wire/json_error.h"

namespace eyrie::api {
namespace {

namespace fs = std::filesystem;
using google::protobuf::util::MessageDifferencer;

constexpr std::string_view kName = "state.json";
constexpr std::uintmax_t kMostBytes = 64 << 20;
constexpr std::string_view kLockName = ".state.json.lock";
constexpr int kPausesAfterFailure = 10;
constexpr int kPausesForAnother = 2;
constexpr std::chrono::milliseconds kLookAgain{10};  // at another's lock, in these

std::string text(const absl::Status& status) { return std::string(status.message()); }

absl::StatusOr<v1::KeptState> read(const access::DataFolder& folder) {
    ASSIGN_OR_RETURN(const fs::path path, folder.place(kName));
    v1::KeptState state;
    std::error_code error;
    const std::uintmax_t bytes = fs::file_size(path, error);
    if (error == std::errc::no_such_file_or_directory)
        return state;
    if (!error && bytes > kMostBytes)
        return absl::DataLossError(
            fmt::format("it has {} bytes; at most {} are read", bytes, kMostBytes));
    std::ifstream file(path, std::ios::binary);
    if (error || !file)
        return absl::UnavailableError("the server may not read it");
    const std::string json(std::istreambuf_iterator<char>(file), {});
    google::protobuf::util::JsonParseOptions options;
    options.ignore_unknown_fields = true;  // of a newer version
    const auto parsed = google::protobuf::util::JsonStringToMessage(json, &state, options);
    if (!parsed.ok())
        return absl::DataLossError(
            wire::jsonError({parsed.message().data(), parsed.message().size()}).text());
    return state;
}

void setAside(const access::DataFolder& folder, const absl::Status& reason) {
    const fs::path path = folder.path() / kName;
    const fs::path aside = folder.path() / fmt::format("{}.damaged", kName);
    std::error_code error;
    fs::rename(path, aside, error);
    spdlog::warn("{} of the data folder cannot be read, and what was set before is lost: {}; {}",
                 kName, text(reason),
                 error ? fmt::format("it cannot be set aside either: {}", error.message())
                       : fmt::format("it is {} now", aside.filename().string()));
}

}  // namespace

StateFile::StateFile(access::DataFolder folder, std::string configurationFile,
                     std::chrono::milliseconds pause)
    : folder_(std::move(folder)),
      configurationFile_(std::move(configurationFile)),
      pause_(pause),
      state_(std::make_unique<v1::KeptState>()) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point end = Clock::now() + kPausesForAnother * pause_;
    bool isAnothers = absl::IsFailedPrecondition(takeLock());
    for (; isAnothers && Clock::now() < end; isAnothers = absl::IsFailedPrecondition(takeLock()))
        std::this_thread::sleep_for(kLookAgain);
    if (absl::StatusOr<v1::KeptState> found = read(folder_); found.ok())
        *state_ = *std::move(found);
    else
        setAside(folder_, found.status());
    isWritten_ = !isAnothers;  // once it can be, it has what is shown here
    thread_ = std::jthread([this](const std::stop_token& stop) { writeChanges(stop); });
}

StateFile::~StateFile() = default;

coordinator::KeptConfiguration StateFile::configuration() const {
    const std::lock_guard lock(mutex_);
    if (!state_->has_configuration())
        return {};
    const v1::KeptConfiguration& kept = state_->configuration();
    if (kept.file() == configurationFile_)
        return fromMessage(kept);
    const auto called = [](const std::string& file) {
        return file.empty() ? std::string("the configuration without --config") : file;
    };
    spdlog::warn("what was set before is left out: it was set of {}, and {} is at work",
                 called(kept.file()), called(configurationFile_));
    return {};
}

void StateFile::keep(const coordinator::KeptConfiguration& configuration) {
    const v1::KeptConfiguration message = toMessage(configuration, configurationFile_);
    const std::lock_guard lock(mutex_);
    change(message, *state_->mutable_configuration());
}

v1::KeptScene StateFile::scene() const {
    const std::lock_guard lock(mutex_);
    return state_->scene();
}

void StateFile::keep(const v1::KeptScene& scene) {
    const std::lock_guard lock(mutex_);
    change(scene, *state_->mutable_scene());
}

void StateFile::forgetScene() {
    const std::lock_guard lock(mutex_);
    change(v1::KeptScene(), *state_->mutable_scene());
}

template <typename Message>
void StateFile::change(const Message& now, Message& part) {
    if (MessageDifferencer::Equals(now, part))
        return;
    part = now;
    isWritten_ = false;
    changed_.notify_all();
}

void StateFile::writeChanges(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    while (changed_.wait(lock, stop, [this] { return !isWritten_; })) {
        const std::string json = wire::toJson(*state_);
        isWritten_ = true;
        lock.unlock();
        const absl::Status written = write(json);
        lock.lock();
        if (written.ok() && stop.stop_requested())
            continue;
        if (stop.stop_requested())
            return;
        isWritten_ = isWritten_ && written.ok();
        const bool isSoon = written.ok() || absl::IsFailedPrecondition(written);
        changed_.wait_for(lock, stop, isSoon ? pause_ : pause_ * kPausesAfterFailure,
                          [] { return false; });
    }
}

absl::Status StateFile::takeLock() {
    if (isOurs_)
        return absl::OkStatus();
    const absl::StatusOr<fs::path> path = folder_.place(kLockName);
    if (!path.ok())
        return absl::UnavailableError(path.status().message());
    absl::StatusOr<FileLock> lock = FileLock::take(*path);
    if (lock.ok())
        lock_.emplace(*std::move(lock));
    else if (absl::IsUnimplemented(lock.status()))
        spdlog::warn(
            "the data folder's file system has no locks ({}); see that no other "
            "coordinator has this folder",
            text(lock.status()));
    else
        return lock.status();
    isOurs_ = true;
    return absl::OkStatus();
}

absl::Status StateFile::tryToWrite(const std::string& json) {
    constexpr std::string_view kRemedy = "see that the data folder is writable and not full";
    const absl::Status lock = takeLock();
    if (absl::IsFailedPrecondition(lock))
        return absl::FailedPreconditionError(
            "another coordinator has this data folder; end that one, or give each a folder of its "
            "own");
    if (!lock.ok())
        return absl::UnavailableError(fmt::format("{}; {}", text(lock), kRemedy));
    const absl::StatusOr<fs::path> path = folder_.place(kName);
    if (!path.ok())
        return absl::UnavailableError(path.status().message());
    const std::error_code error = replaceFile(*path, json, Readers::OwnerAlone);
    return error ? absl::UnavailableError(fmt::format("{}; {}", error.message(), kRemedy))
                 : absl::OkStatus();
}

absl::Status StateFile::write(const std::string& json) {
    const absl::Status status = tryToWrite(json);
    if (const std::string problem = text(status); problem != problem_ && !status.ok())
        spdlog::warn("{} cannot be written, and what is set now is lost at a restart: {}", kName,
                     problem);
    else if (problem != problem_)
        spdlog::info("{} can be written now", kName);
    problem_ = text(status);
    return status;
}

}  // namespace eyrie::api
