// SPDX-License-Identifier: Apache-2.0
#include "access/tokens.h"

#include <algorithm>
#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "access/printable.h"
#include "access/ticket.h"
#include "fabric/status.h"

namespace eyrie::access {
namespace {

constexpr std::size_t kMaxFileBytes = 256 * 1024;
constexpr std::size_t kMaxTokens = 1000;
constexpr std::string_view kBlanks = " \t\r";

/// An open file, closed at the end.
class Descriptor {
public:
    explicit Descriptor(int id) : id_(id) {}
    ~Descriptor() {
        if (id_ >= 0)
            ::close(id_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int id() const { return id_; }

private:
    int id_;
};

absl::Status cannotRead(const std::string& name, int error) {
    const std::string text =
        fmt::format("token file {}: {}", name, std::generic_category().message(error));
    return error == ENOENT ? absl::NotFoundError(text) : absl::PermissionDeniedError(text);
}

absl::Status checkMode(const struct stat& facts, const std::string& name) {
    if (!S_ISREG(facts.st_mode))
        return absl::InvalidArgumentError(fmt::format("token file {}: not a file", name));
    if ((facts.st_mode & (S_IRWXO | S_IWGRP)) != 0)
        return absl::PermissionDeniedError(fmt::format(
            "token file {}: mode is {:04o}, so that others can read or change it; chmod 600 it",
            name, facts.st_mode & 07777U));
    if (static_cast<std::size_t>(facts.st_size) > kMaxFileBytes)
        return absl::InvalidArgumentError(
            fmt::format("token file {}: more than {} bytes", name, kMaxFileBytes));
    return absl::OkStatus();
}

std::optional<Role> roleNamed(std::string_view name) {
    for (const Role role : {Role::View, Role::Control, Role::Admin})
        if (name == nameOf(role))
            return role;
    return std::nullopt;
}

/// The characters that HTTP allows in a bearer token (RFC 6750).
bool isTokenCharacter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("-._~+/=").find(c) != std::string_view::npos;
}

std::string_view trimmed(std::string_view text) {
    const std::size_t begin = std::min(text.find_first_not_of(kBlanks), text.size());
    text.remove_prefix(begin);
    return text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

}  // namespace

std::string_view nameOf(Role role) {
    switch (role) {
        case Role::View:
            return "view";
        case Role::Control:
            return "control";
        case Role::Admin:
            break;
    }
    return "admin";
}

absl::StatusOr<Tokens> Tokens::read(const std::filesystem::path& file) {
    const std::string name = file.string();
    const Descriptor descriptor(::open(name.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    struct stat facts {};
    if (descriptor.id() < 0 || ::fstat(descriptor.id(), &facts) != 0)
        return cannotRead(name, errno);
    RETURN_IF_ERROR(checkMode(facts, name));
    std::string text(kMaxFileBytes, '\0');
    std::size_t size = 0;
    while (size < text.size()) {
        const ssize_t count = ::read(descriptor.id(), text.data() + size, text.size() - size);
        if (count < 0)
            return cannotRead(name, errno);
        if (count == 0)
            break;
        size += static_cast<std::size_t>(count);
    }
    return parse(std::string_view(text).substr(0, size), fmt::format("token file {}", name));
}

absl::StatusOr<Tokens> Tokens::parse(std::string_view text, std::string_view name) {
    Tokens result;
    int number = 0;
    for (std::size_t begin = 0; begin < text.size(); ++number) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        const std::string_view line = trimmed(text.substr(begin, end - begin));
        begin = end + 1;
        if (line.empty() || line.front() == '#')
            continue;
        RETURN_IF_ERROR(result.add(line, fmt::format("{}: line {}", name, number + 1)));
    }
    if (result.tokens_.empty())
        return absl::InvalidArgumentError(
            fmt::format("{}: no tokens; a line is a role (view, control or admin) and a token, "
                        "such as `openssl rand -hex 16` makes",
                        name));
    return result;
}

absl::Status Tokens::add(std::string_view line, std::string_view place) {
    const std::size_t gap = std::min(line.find_first_of(kBlanks), line.size());
    const std::optional<Role> role = roleNamed(line.substr(0, gap));
    const std::string_view secret = trimmed(line.substr(gap));
    if (!role)  // what stands there may be a token without its role: not for the log
        return absl::InvalidArgumentError(
            fmt::format("{}: the first word is not view, control or admin", place));
    if (secret.size() < kMinBytes || secret.size() > kMaxBytes)
        return absl::InvalidArgumentError(
            fmt::format("{}: the token has {} characters, not {} to {}; `openssl rand -hex 16` "
                        "makes one",
                        place, secret.size(), kMinBytes, kMaxBytes));
    if (!std::all_of(secret.begin(), secret.end(), isTokenCharacter))
        return absl::InvalidArgumentError(
            fmt::format("{}: a token has letters, digits and -._~+/= only", place));
    if (tokens_.size() >= kMaxTokens)
        return absl::InvalidArgumentError(
            fmt::format("{}: more than {} tokens", place, kMaxTokens));
    if (roleOf(secret))
        return absl::InvalidArgumentError(fmt::format("{}: the token is there already", place));
    Token& token = tokens_.emplace_back();
    token.role = *role;
    token.secret.assign(secret);
    marks_.insert(markOf(secret));
    return absl::OkStatus();
}

std::optional<Role> Tokens::roleOf(std::string_view secret) const {
    std::optional<Role> found;
    for (const Token& token : tokens_)
        if (isSame(token.secret, secret))
            found = token.role;
    return found;
}

std::optional<Role> Tokens::roleOfTicket(std::string_view ticket, std::int64_t now) const {
    const std::optional<std::int64_t> expires = expiryOf(ticket);
    if (!expires || *expires <= now)
        return std::nullopt;
    std::optional<Role> found;
    for (const Token& token : tokens_)
        if (isSame(makeTicket(token.secret, *expires), ticket))
            found = token.role;
    return found;
}

std::string_view Tokens::first(Role role) const {
    for (const Token& token : tokens_)
        if (token.role == role)
            return token.secret;
    return {};
}

}  // namespace eyrie::access
