// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <absl/status/status.h>

/// Names of data that lie elsewhere: `https://host/x.eyt`, `http://…`, and GDAL's virtual file
/// systems (`/vsicurl/https://…`, `/vsis3/bucket/x.eyt`, `/vsigs/…`, `/vsiaz/…`). The case of
/// `http` does not matter. All else is a path of this machine.
namespace eyrie::page {

/// Of archives (`/vsizip/data/a.zip/x.eyt`, `/vsitar/…`, `/vsigzip/…`) all that may lie elsewhere
/// does: only those of plain paths of this machine do not.
bool isRemote(std::string_view path);

/// Whether GDAL alone reads it: it is remote, or in an archive of this machine.
bool isVirtual(std::string_view path);

/// Whether it is a path of this machine's file system: neither virtual nor what checkScheme()
/// refuses.
bool isPlainPath(const std::string& path);

/// InvalidArgument, with the remedy, for addresses of another kind, such as `s3://bucket/x.eyt`:
/// nobody means a file of this machine by them.
absl::Status checkScheme(const std::string& path);

/// As GDAL's virtual file systems call it: `https://…` is `/vsicurl/https://…`.
std::string gdalName(const std::string& url);

/// Without what follows `?` or `#` in an http(s) address: its ending says what the file is.
std::string withoutQuery(const std::string& path);

/// Which addresses a process reads from when somebody else names them. Paths of this machine are
/// not its concern.
class AllowedUrls {
public:
    /// Each prefix ends where a part of the address does: `https://data.example/dem` allows
    /// `https://data.example/dem/a.eyt`, not `https://data.example/demo.eyt`. "any" allows all.
    explicit AllowedUrls(std::vector<std::string> prefixes = {});

    /// PermissionDenied, naming the address and the remedy. A server may still send a reader on to
    /// another address: allow servers that are trusted not to.
    absl::Status check(const std::string& path) const;

private:
    std::vector<std::string> prefixes_;
};

}  // namespace eyrie::page
