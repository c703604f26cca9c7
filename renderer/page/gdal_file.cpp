// SPDX-License-Identifier: Apache-2.0
// GDAL's virtual file systems (GDAL/OGR contributors, "GDAL/OGR Geospatial Data Abstraction
// software Library", Open Source Geospatial Foundation; version 3.6 was looked at).
//
// VSIFReadL would answer a stalled server, an error status and a connection closed midway alike
// with fewer bytes, and keep what it got, the file's size and whether it exists in caches of the
// process. So pages are read with PRead, which asks the server each time and keeps nothing, and
// files are opened after what GDAL remembers of them was dropped. PRead says how many bytes came
// but not why there are no more: opening the file once more does. Of an error that an object store
// answers GDAL passes on the text, which is each store's own, and the status only to who debugs it.
#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cstring>
#include <mutex>
#include <utility>

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_vsi.h>
#include <cpl_vsi_error.h>
#include <cpl_vsi_virtual.h>
#include <fmt/format.h>

#include "fabric/status.h"
#include "renderer/page/byte_source.h"
#include "renderer/page/remote_name.h"

namespace eyrie::page {
namespace {

constexpr std::size_t kMostBytesOfARequest = std::size_t{1} << 20;
constexpr std::chrono::seconds kLongWait{2};

struct Setting {
    const char* name;
    const char* value;
};
constexpr std::array kSettings = {
    Setting{"GDAL_HTTP_CONNECTTIMEOUT", "5"},
    Setting{"GDAL_HTTP_LOW_SPEED_TIME", "5"},
    Setting{"GDAL_HTTP_LOW_SPEED_LIMIT", "1000"},
    Setting{"GDAL_HTTP_TIMEOUT", "30"},
    // The loader tries again, with its own pauses.
    Setting{"GDAL_HTTP_MAX_RETRY", "0"},
    // Opening a file would list its folder.
    Setting{"GDAL_DISABLE_READDIR_ON_OPEN", "EMPTY_DIR"},
    // GdalScope alone hears it.
    Setting{"CPL_DEBUG", "ON"},
};

/// The number after the last `mark`, 0 without one.
int numberAfter(std::string_view text, std::string_view mark) {
    const std::size_t at = text.rfind(mark);
    int number = 0;
    if (at != std::string_view::npos)
        std::from_chars(text.data() + at + mark.size(), text.data() + text.size(), number);
    return number;
}

/// Sets up GDAL for this thread while it lives, and catches what GDAL would print. What the user
/// has set stays as it is.
class GdalScope {
public:
    GdalScope() {
        for (std::size_t i = 0; i < kSettings.size(); ++i)
            if (CPLGetConfigOption(kSettings[i].name, nullptr) == nullptr) {
                CPLSetThreadLocalConfigOption(kSettings[i].name, kSettings[i].value);
                isSet_[i] = true;
            }
        CPLPushErrorHandlerEx(&GdalScope::note, this);
        CPLErrorReset();
        VSIErrorReset();
    }
    ~GdalScope() {
        CPLPopErrorHandler();
        for (std::size_t i = 0; i < kSettings.size(); ++i)
            if (isSet_[i])
                CPLSetThreadLocalConfigOption(kSettings[i].name, nullptr);
    }
    GdalScope(const GdalScope&) = delete;
    GdalScope& operator=(const GdalScope&) = delete;

    /// What GDAL has said of a failure; empty when nothing.
    std::string said() const {
        const char* vsi = VSIGetLastErrorNo() != 0 ? VSIGetLastErrorMsg() : "";
        return *vsi != '\0' ? std::string(vsi) : error_;
    }
    /// The HTTP status of the last answer when a file was opened, 0 without one.
    int httpStatus() const { return httpStatus_; }

private:
    static void CPL_STDCALL note(CPLErr severity, CPLErrorNum, const char* message) {
        auto& self = *static_cast<GdalScope*>(CPLGetErrorHandlerUserData());
        if (severity >= CE_Failure && self.error_.empty())
            self.error_ = message;
        if (const int status = severity == CE_Debug ? numberAfter(message, "response_code=") : 0)
            self.httpStatus_ = status;
    }

    std::array<bool, kSettings.size()> isSet_{};
    std::string error_;
    int httpStatus_ = 0;
};

absl::Status unavailable(const std::string& url, const std::string& why) {
    return absl::UnavailableError(
        fmt::format("{}: {}; look at the server and the network, then try again", url, why));
}

absl::Status rangesRefused(const std::string& url) {
    return absl::InvalidArgumentError(
        fmt::format("{}: the server sends whole files where a range is asked for; use one that "
                    "answers range requests, or download the file",
                    url));
}

/// Where GDAL looks for what whoever may read `url` has.
std::string_view credentialsFor(std::string_view url) {
    const auto isOf = [url](std::string_view system) { return url.find(system) != url.npos; };
    if (isOf("/vsis3"))
        return "AWS_ACCESS_KEY_ID and AWS_SECRET_ACCESS_KEY (of temporary ones AWS_SESSION_TOKEN, "
               "too), or AWS_NO_SIGN_REQUEST=YES for public data";
    if (isOf("/vsigs"))
        return "GOOGLE_APPLICATION_CREDENTIALS, or GS_ACCESS_KEY_ID and GS_SECRET_ACCESS_KEY";
    if (isOf("/vsiaz"))
        return "AZURE_STORAGE_CONNECTION_STRING, or AZURE_STORAGE_ACCOUNT and "
               "AZURE_STORAGE_ACCESS_KEY";
    if (isOf("http:") || isOf("https:"))
        return "GDAL_HTTP_USERPWD=USER:PASSWORD";
    return "see GDAL's documentation of this file system";
}

absl::Status denied(const std::string& url, int http, const std::string& said) {
    const std::string answer =
        said.starts_with("HTTP ") ? said : fmt::format("HTTP {}: {}", http, said);
    const std::string why = http == 0 ? fmt::format("access needs credentials ({})", said)
                                      : fmt::format("the server denies access ({})", answer);
    return absl::PermissionDeniedError(
        fmt::format("{}: {}; correct the address, or set credentials in the environment: {}", url,
                    why, credentialsFor(url)));
}

/// Object stores answer 400, too, where a token has expired or is somebody else's.
bool isDenial(int http, int vsi) {
    if (vsi == VSIE_AWSAccessDenied || vsi == VSIE_AWSInvalidCredentials ||
        vsi == VSIE_AWSSignatureDoesNotMatch)
        return true;
    return http == 401 || http == 403 || http == 407 || (http == 400 && vsi == VSIE_AWSError);
}

/// Why a file could not be opened, of what GDAL said.
absl::Status whyNotOpen(const std::string& url, const GdalScope& gdal) {
    const std::string said = gdal.said();
    const int http = std::max(gdal.httpStatus(), numberAfter(said, "HTTP response code: "));
    const int vsi = VSIGetLastErrorNo();
    if (http == 404 || http == 410 || vsi == VSIE_AWSObjectNotFound ||
        vsi == VSIE_AWSBucketNotFound)
        return absl::NotFoundError(
            fmt::format("{}: the server has no such file ({}); correct the address", url, said));
    if (isDenial(http, vsi))
        return denied(url, http, said);
    if (said.empty())
        return absl::NotFoundError(fmt::format("{}: there is no such file", url));
    return unavailable(url, said);
}

struct CloseFile {
    void operator()(VSIVirtualHandle* file) const { VSIFCloseL(reinterpret_cast<VSILFILE*>(file)); }
};
using Handle = std::shared_ptr<VSIVirtualHandle>;

/// Asks the server, whatever GDAL remembers.
absl::StatusOr<Handle> openAnew(const std::string& url) {
    const std::string name = gdalName(url);
    GdalScope gdal;
    VSICurlPartialClearCache(name.c_str());
    VSILFILE* file = VSIFOpenEx2L(name.c_str(), "rb", TRUE, nullptr);
    if (file == nullptr)
        return whyNotOpen(url, gdal);
    return Handle(reinterpret_cast<VSIVirtualHandle*>(file), CloseFile());
}

std::uint64_t sizeOf(VSIVirtualHandle& file) {
    const GdalScope gdal;
    return file.Seek(0, SEEK_END) == 0 ? static_cast<std::uint64_t>(file.Tell()) : 0;
}

class GdalFile final : public ByteSource {
public:
    GdalFile(std::string url, Handle handle, std::uint64_t sizeBytes)
        : url_(std::move(url)), sizeBytes_(sizeBytes), handle_(std::move(handle)) {}

    std::uint64_t sizeBytes() const override { return sizeBytes_; }

    absl::Status read(std::uint64_t offset, std::span<std::byte> into) const override {
        ASSIGN_OR_RETURN(const Handle file, handle());
        while (!into.empty()) {
            const std::span<std::byte> piece =
                into.first(std::min(into.size(), kMostBytesOfARequest));
            RETURN_IF_ERROR(readPiece(*file, offset, piece));
            into = into.subspan(piece.size());
            offset += piece.size();
        }
        return absl::OkStatus();
    }

private:
    using Clock = std::chrono::steady_clock;

    /// Opened by now, or opens it. Not under the mutex: a server may take its time.
    absl::StatusOr<Handle> handle() const {
        {
            const std::lock_guard lock(mutex_);
            if (handle_)
                return handle_;
        }
        ASSIGN_OR_RETURN(Handle opened, openAnew(url_));
        RETURN_IF_ERROR(checkSize(sizeOf(*opened)));
        const std::lock_guard lock(mutex_);
        if (!handle_)
            handle_ = std::move(opened);
        return handle_;
    }

    absl::Status checkSize(std::uint64_t now) const {
        if (now == sizeBytes_)
            return absl::OkStatus();
        return absl::DataLossError(
            fmt::format("{}: has changed on the server since it was opened ({} bytes then, {} "
                        "now); open the scene again",
                        url_, sizeBytes_, now));
    }

    absl::Status readPiece(VSIVirtualHandle& file, std::uint64_t offset,
                           std::span<std::byte> into) const {
        const auto begin = Clock::now();
        std::string said;
        std::size_t got = 0;
        {
            const GdalScope gdal;
            got = file.HasPRead() ? file.PRead(into.data(), into.size(), offset)
                                  : seekAndRead(file, offset, into);
            said = gdal.said();
        }
        if (got == into.size())
            return absl::OkStatus();
        return whyNotRead(offset, into.size(), got > into.size() ? 0 : got, said,
                          Clock::now() - begin);
    }

    /// For file systems that have one position for all threads, such as archives.
    std::size_t seekAndRead(VSIVirtualHandle& file, std::uint64_t offset,
                            std::span<std::byte> into) const {
        const std::lock_guard lock(mutex_);
        return file.Seek(offset, SEEK_SET) == 0 ? file.Read(into.data(), 1, into.size()) : 0;
    }

    absl::Status whyNotRead(std::uint64_t offset, std::size_t asked, std::size_t got,
                            const std::string& said, Clock::duration took) const {
        if (said.find("Range downloading not supported") != std::string::npos)
            return rangesRefused(url_);
        const std::string what = fmt::format("{} of {} bytes at {} came", got, asked, offset);
        const std::string reason = said.empty() ? "" : ": " + said;
        // It has just been waited for in vain: asking why would take as long again.
        if (took > kLongWait)
            return unavailable(url_,
                               fmt::format("{} in {:.0f} s, which is too slow{}", what,
                                           std::chrono::duration<double>(took).count(), reason));
        // If that fails GDAL takes the file as gone, in the handle that was open, too.
        absl::StatusOr<Handle> again = openAnew(url_);
        const std::uint64_t size = again.ok() ? sizeOf(**again) : 0;  // while nobody else reads it
        {
            const std::lock_guard lock(mutex_);
            handle_ = again.ok() ? *again : nullptr;
        }
        RETURN_IF_ERROR(again.status());
        RETURN_IF_ERROR(checkSize(size));
        return unavailable(url_, what + reason);
    }

    const std::string url_;
    const std::uint64_t sizeBytes_;
    mutable std::mutex mutex_;  ///< guards handle_, and the position of files without PRead
    mutable Handle handle_;
};

}  // namespace

absl::StatusOr<std::unique_ptr<ByteSource>> openRemoteFile(const std::string& url) {
    ASSIGN_OR_RETURN(Handle handle, openAnew(url));
    const std::uint64_t size = sizeOf(*handle);
    return std::make_unique<GdalFile>(url, std::move(handle), size);
}

std::unique_ptr<ByteSource> awaitRemoteFile(const std::string& url, std::uint64_t sizeBytes) {
    return std::make_unique<GdalFile>(url, nullptr, sizeBytes);
}

}  // namespace eyrie::page
