// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fstream>

#include <sys/resource.h>
#include <unistd.h>

namespace eyrie::test {

/// While it lives this process can have that much more memory. Sanitizers, which take their own,
/// cannot be limited so.
class MemoryLimit {
public:
    static constexpr bool kIsPossible =
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
        false;
#else
        true;
#endif

    explicit MemoryLimit(rlim_t bytes) {
        getrlimit(RLIMIT_AS, &before_);
        rlim_t pages = 0;
        std::ifstream("/proc/self/statm") >> pages;
        const rlimit limit{pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + bytes,
                           before_.rlim_max};
        setrlimit(RLIMIT_AS, &limit);
    }
    MemoryLimit(const MemoryLimit&) = delete;
    MemoryLimit& operator=(const MemoryLimit&) = delete;
    ~MemoryLimit() { setrlimit(RLIMIT_AS, &before_); }

private:
    rlimit before_{};
};

}  // namespace eyrie::test
