// SPDX-License-Identifier: Apache-2.0
#include "renderer/effects/language/shader_log.h"

#include <array>

#include <gtest/gtest.h>

namespace eyrie::effects {
namespace {

TEST(ShaderLog, NamesFilesInTheLogsOfEveryCompiler) {
    const std::array<std::string, 2> files{"object.block", "terrain.effect"};
    EXPECT_EQ(namedLog("ERROR: 0:2000012: 'x' : undeclared identifier\n", files),
              "terrain.effect:12: error: 'x' : undeclared identifier");
    EXPECT_EQ(namedLog("WARNING: 0:3: odd\n", files), "object.block:3: warning: odd");
    EXPECT_EQ(namedLog("0:2000012(5): error: `x' undeclared\n0:1(2): warning: y\n", files),
              "terrain.effect:12:5: error: `x' undeclared\nobject.block:1:2: warning: y");
    EXPECT_EQ(namedLog("0(2000012) : error C1008: undefined variable\n", files),
              "terrain.effect:12: error C1008: undefined variable");
}

TEST(ShaderLog, LeavesLinesWithoutAPlaceAsTheyAre) {
    const std::array<std::string, 1> files{"a.effect"};
    for (const char* line :
         {"error: linking failed", "0:14000012: no such file", "0", "0:", "0:x: y", "0(3",
          "ERROR: 2 compilation errors.  No code generated.", "99999999999999999999:1: z"})
        EXPECT_EQ(namedLog(line, files), line);
    EXPECT_EQ(namedLog("", files), "");
    EXPECT_EQ(namedLog("\n\n a\n", files), " a");
}

}  // namespace
}  // namespace eyrie::effects
