// SPDX-License-Identifier: Apache-2.0
// Effect files of any bytes: parsed or refused, and what was accepted can be written as GLSL.
#include <cstdint>
#include <string_view>

#include "renderer/effects/language/effect_loader.h"
#include "renderer/effects/language/glsl_writer.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace eyrie::effects;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    // Included blocks have the same text, so that one input reaches both kinds of file.
    const ReadEffectFile read = [&](std::string_view) { return std::string(text); };
    if (const auto effect = loadEffect("fuzzed.effect", read); effect.ok()) {
        declarations(*effect);
        allVariants(*effect);
        stageText(*effect, StageKind::Vertex);
        stageText(*effect, StageKind::Fragment);
    }
    static_cast<void>(loadBlock("fuzzed.block", read));
    return 0;
}
