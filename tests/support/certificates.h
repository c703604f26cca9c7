// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "access/tls_files.h"
#include "tests/support/temporary_folder.h"

namespace eyrie::test {

/// A certificate authority with files in a folder of its own.
class Authority {
public:
    /// `name` goes into its certificate.
    explicit Authority(const std::string& name);

    struct Holder {
        std::string name = "127.0.0.1";  ///< an IP address or DNS name
        long validFromSeconds = -3600;   ///< from now
        long validToSeconds = 3600;
    };

    /// Files `FILE.crt` and `FILE.key` of a certificate for `holder`, in place of those before.
    access::TlsFiles issue(const std::string& file, const Holder& holder) const;
    access::TlsFiles issue(const std::string& file) const { return issue(file, Holder()); }

    /// Its own certificate.
    std::string file() const { return folder_.path("ca.crt"); }

private:
    TemporaryFolder folder_;
    std::string name_;
};

}  // namespace eyrie::test
