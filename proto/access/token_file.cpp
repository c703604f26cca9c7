// SPDX-License-Identifier: Apache-2.0
#include "access/token_file.h"

#include <string_view>
#include <utility>

#include <sys/stat.h>

#include "fabric/log.h"
#include "fabric/status.h"

namespace eyrie::access {

absl::StatusOr<std::shared_ptr<TokenFile>> TokenFile::open(const std::filesystem::path& file) {
    std::shared_ptr<TokenFile> opened(new TokenFile(file));
    RETURN_IF_ERROR(opened->load());
    return opened;
}

std::shared_ptr<const Tokens> TokenFile::current() {
    const std::lock_guard lock(mutex_);
    if (stamp() == loaded_)
        return tokens_;
    const absl::Status status = load();
    if (status.ok())
        spdlog::info("who comes in has a token that is now in {}", file_.string());
    else
        spdlog::warn("the tokens stay as they were: {}",
                     std::string_view(status.message().data(), status.message().size()));
    return tokens_;
}

absl::Status TokenFile::load() {
    // Before the file is read: what changes meanwhile is seen at the next look.
    loaded_ = stamp();
    ASSIGN_OR_RETURN(Tokens tokens, Tokens::read(file_));
    tokens_ = std::make_shared<const Tokens>(std::move(tokens));
    return absl::OkStatus();
}

TokenFile::Stamp TokenFile::stamp() const {
    struct stat facts {};
    if (::stat(file_.c_str(), &facts) != 0)
        return {};
    // The time of change sees modes, too, which may be what was wrong.
    return {static_cast<std::int64_t>(facts.st_ino),
            facts.st_size,
            facts.st_mtim.tv_sec,
            facts.st_mtim.tv_nsec,
            facts.st_ctim.tv_sec,
            facts.st_ctim.tv_nsec};
}

}  // namespace eyrie::access
