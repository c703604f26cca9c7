// SPDX-License-Identifier: Apache-2.0
#include "tools/effect_compiler/cpp_writer.h"

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "renderer/effects/language/effect_loader.h"

namespace eyrie::effects {
namespace {

const std::string kFolder = EYRIE_SOURCE_DIR "/tests/tools/effect_compiler";

/// Compares with the golden file and leaves what was written beside the test's program.
void expectGolden(const std::string& written, const std::string& name) {
    std::ifstream file(kFolder + "/" + name);
    std::ostringstream golden;
    golden << file.rdbuf();
    const std::string actual = testing::TempDir() + name;
    std::ofstream(actual) << written;
    EXPECT_EQ(written, golden.str()) << "to accept: cp " << actual << " " << kFolder;
}

TEST(CppWriter, WritesTheGoldenClassOfATinyEffect) {
    const auto effect = loadEffect("tiny.effect", effectFolder(kFolder));
    ASSERT_TRUE(effect.ok()) << effect.status();
    expectGolden(effectHeader(*effect), "tiny_effect.golden");
}

TEST(CppWriter, WritesTheGoldenClassOfATinyBlock) {
    const auto block = loadBlock("light.block", effectFolder(kFolder));
    ASSERT_TRUE(block.ok()) << block.status();
    expectGolden(blockHeader(*block), "light_block.golden");
}

}  // namespace
}  // namespace eyrie::effects
