// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"

namespace eyrie::test {

/// An object store on the loopback that answers those alone who sign as S3 wants it: s3_server.py.
class S3Server {
public:
    static constexpr const char* kKeyId = "AKIAOFTESTS";
    static constexpr const char* kSecret = "the/secret+of/tests";
    static constexpr const char* kRegion = "eu-central-1";

    /// Folders of `data` are buckets. Starts it; throws when it does not.
    explicit S3Server(const std::filesystem::path& data, const std::string& sessionToken = "")
        : process_({"/usr/bin/env", "python3", EYRIE_SOURCE_DIR "/tests/support/s3_server.py",
                    data.string()},
                   environment(sessionToken)) {
        if (!process_.waitForOutput("\n", std::chrono::seconds(30)))
            throw std::runtime_error("s3_server.py does not start: " + process_.errors());
        const std::string printed = process_.output();
        port_ = printed.substr(0, printed.find('\n'));
    }

    std::string address() const { return "127.0.0.1:" + port_; }
    /// A line for each request so far: method, path, range, status, the error's code.
    std::string log() const { return process_.output().substr(port_.size() + 1); }
    /// Denies what comes after so many requests.
    void grant(int requests) const { folder_.write("grants", std::to_string(requests)); }
    void grantAll() const { std::filesystem::remove(folder_.path("grants")); }

private:
    std::vector<std::string> environment(const std::string& sessionToken) const {
        return {std::string("S3_KEY_ID=") + kKeyId, std::string("S3_SECRET=") + kSecret,
                std::string("S3_REGION=") + kRegion, "S3_SESSION_TOKEN=" + sessionToken,
                "S3_GRANTS=" + folder_.path("grants")};
    }

    TemporaryFolder folder_;
    Process process_;
    std::string port_;
};

}  // namespace eyrie::test
