// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"

namespace eyrie::test {

/// A real nginx on the loopback that serves a folder, with a configuration of its own.
class Nginx {
public:
    /// Starts it and waits until it answers; throws when it does not.
    explicit Nginx(const std::filesystem::path& data);

    std::string url(const std::string& name) const;
    /// Of all answers' bodies so far.
    std::uint64_t bytesSent() const;
    void stop() { process_.reset(); }
    /// Again, at the same port.
    void start();

private:
    TemporaryFolder folder_;
    std::uint16_t port_;
    std::unique_ptr<Process> process_;
};

}  // namespace eyrie::test
