# SPDX-License-Identifier: Apache-2.0
# cmake -D FROM=file -D TO=header -D NAME=array -P: a file's bytes as a C++ array.
file(READ ${FROM} bytes HEX)
string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
file(WRITE ${TO} "#pragma once\n\ninline constexpr unsigned char ${NAME}[] = {\n${bytes}\n};\n")
