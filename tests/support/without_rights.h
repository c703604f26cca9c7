// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/fsuid.h>

namespace eyrie::test {

/// Another user's rights to files, of this thread and of those that it starts: root could write
/// anywhere.
class WithoutRights {
public:
    WithoutRights() : before_(setfsuid(65534)) {}
    ~WithoutRights() { setfsuid(static_cast<uid_t>(before_)); }
    WithoutRights(const WithoutRights&) = delete;
    WithoutRights& operator=(const WithoutRights&) = delete;

private:
    const int before_;
};

}  // namespace eyrie::test
