// SPDX-License-Identifier: Apache-2.0
// What is read of models before Assimp reads them, or beside it, of any bytes: X3D, COLLADA, AMF,
// DXF, STL, OFF, OBJ and its material files, models of 3MF. What one has mended needs no mending.
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/import/amf_text.h"
#include "renderer/import/collada_text.h"
#include "renderer/import/dxf_text.h"
#include "renderer/import/obj_text.h"
#include "renderer/import/obj_textures.h"
#include "renderer/import/off_text.h"
#include "renderer/import/stated_unit.h"
#include "renderer/import/stl_colours.h"
#include "renderer/import/stl_length.h"
#include "renderer/import/stl_text.h"
#include "renderer/import/three_mf.h"
#include "renderer/import/uri_name.h"
#include "renderer/import/x3d_caveats.h"
#include "renderer/import/x3d_text.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace eyrie::import;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto bytes = std::as_bytes(std::span(data, size));
    if (x3dForAssimp(text).size() > 20 * size)
        std::abort();
    x3dCaveats(text);
    colladaForAssimp(text);
    if (const auto amf = amfForAssimp(text); amf && amf->size() > 14 * size)
        std::abort();
    amfCaveats(text);
    for (const char* name : {"m.amf", "m.x3d"}) {
        std::vector<std::string> notes;
        if (!(statedUnitOf(text, *findAssimpFormat(name), notes) > 0))
            std::abort();
    }
    dxfForAssimp(text);
    dxfCaveats(text);
    if (const auto obj = objForAssimp(text); obj && objForAssimp(*obj))
        std::abort();
    if (const auto off = offForAssimp(text); off && offForAssimp(*off))
        std::abort();
    offCaveats(text);
    for (const auto& [name, material] : objMaterialsOf(text))
        if (withoutPercents(material.texture.name).size() > material.texture.name.size())
            std::abort();
    if (mtlForAssimp(mtlForAssimp(text)) != mtlForAssimp(text))
        std::abort();
    (void)countRecoloured3mfObjects(text);
    if (const auto solid = stlTextForAssimp(text); solid && stlTextForAssimp(*solid))
        std::abort();
    const auto stl = stlForAssimp(bytes);
    if (stl && (stl->size() != size || wrongLengthOfStl(std::as_bytes(std::span(*stl)))))
        std::abort();
    return 0;
}
