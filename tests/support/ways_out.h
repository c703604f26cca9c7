// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace eyrie::test {

/// Names that have led out of a folder somewhere: each step up in each spelling, in each place, and
/// more. Some need what data_folder_test has in the folder: links, and secret.txt beside it.
inline std::vector<std::string> waysOut() {
    std::vector<std::string> result;
    const std::vector<std::string> ups = {"..",
                                          "%2e%2e",
                                          "%2E%2E",
                                          ".%2e",
                                          "%2e.",
                                          "%252e%252e",
                                          "..%00",
                                          "%c0%ae%c0%ae",
                                          "\xc0\xae\xc0\xae",
                                          "..;",
                                          "....",
                                          "...",
                                          ".. ",
                                          " ..",
                                          "..\t",
                                          "%u002e%u002e",
                                          "%uff0e%uff0e",
                                          "\xef\xbc\x8e\xef\xbc\x8e",
                                          "\xe2\x80\xa5",
                                          "..\r\n",
                                          "\xe0\x80\xae\xe0\x80\xae",
                                          "..\x7f",
                                          "%%32%65%%32%65",
                                          ".\xe2\x80\x8b.",
                                          "..%0a"};
    const std::vector<std::string> slashes = {"/",     "\\",       "%2f",    "%5c",
                                              "%252f", "\xc0\xaf", "%c0%af", "//"};
    for (const std::string& up : ups)
        for (const std::string& slash : slashes) {
            result.push_back(up + slash + "secret.txt");
            result.push_back("survey" + slash + up + slash + up + slash + "secret.txt");
        }
    for (const char* path : {"/etc/passwd",
                             "//etc/passwd",
                             "///etc/passwd",
                             "\\\\server\\share\\file",
                             "//server/share",
                             "C:\\windows\\win.ini",
                             "C:/windows/win.ini",
                             "c:secret",
                             "file:///etc/passwd",
                             "file:/etc/passwd",
                             "http://127.0.0.1/x",
                             "https://169.254.169.254/latest",
                             "s3://bucket/x",
                             "/vsicurl/http://127.0.0.1/",
                             "/vsizip//etc/x.zip/y",
                             "/vsistdin/",
                             "/vsimem/x",
                             "NETCDF:/etc/passwd",
                             "ZARR:\"/etc\"",
                             "GTIFF_DIR:1:/etc/passwd",
                             "/proc/self/environ",
                             "/proc/self/fd/0",
                             "/dev/stdin",
                             "/dev/zero",
                             "~/secret.txt",
                             "~root/.ssh/id_rsa",
                             "$HOME/secret.txt",
                             "${HOME}",
                             "`id`",
                             "|id",
                             "-o",
                             "--config=/etc/passwd",
                             "",
                             ".",
                             "..",
                             "./secret.txt",
                             "survey/.",
                             "survey/..",
                             "survey/./../..",
                             "survey/",
                             "survey//scan.eym",
                             "/survey",
                             "dem.eyt/",
                             "dem.eyt/..",
                             "dem.eyt/../../secret.txt",
                             "../data-two/secret.txt",
                             "../data/dem.eyt",
                             "..\\data-two\\secret.txt",
                             "passwd",
                             "etc",
                             "etc/passwd",
                             "survey/root",
                             "survey/root/etc/passwd",
                             "survey/root/proc/self/root/etc/passwd",
                             "up.txt",
                             "parent",
                             "parent/secret.txt",
                             "parent/data/dem.eyt",
                             "two",
                             "two/secret.txt",
                             "survey/far.txt",
                             "loop",
                             "loop/x",
                             "dangling",
                             "new.txt",
                             "folder/../../secret.txt",
                             "folder/root/etc/passwd",
                             "self",
                             "self/environ",
                             "self/root/etc/passwd",
                             "self/cwd",
                             "fd",
                             "fd/0",
                             "con",
                             "nul",
                             "aux",
                             "com1",
                             "dem.eyt::$DATA",
                             "dem.eyt:stream",
                             "survey\n/../../secret.txt",
                             "secret.txt\r\nX: y",
                             "\xff\xfe",
                             "\xed\xa0\x80",
                             "\xf4\x90\x80\x80",
                             "\xf8\x88\x80\x80\x80"})
        result.emplace_back(path);
    result.push_back(std::string("dem.eyt\0.txt", 12));
    result.push_back(std::string("..\0/secret.txt", 14));
    result.push_back(std::string("\0", 1));
    result.push_back(std::string("up.txt\0", 7));
    result.push_back(std::string(5000, 'a'));
    result.push_back(std::string(256, 'a'));
    std::string deep;
    for (int i = 0; i < 300; ++i) deep += "../";
    result.push_back(deep + "etc/passwd");
    result.push_back("survey/" + deep + "etc/passwd");
    result.push_back(std::string(1000, '/') + "etc/passwd");
    return result;
}

}  // namespace eyrie::test
