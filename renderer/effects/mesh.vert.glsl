#version 450 core
// SPDX-License-Identifier: Apache-2.0
// Mesh node: 3 x 21-bit positions on the model's lattice, octahedral normals (mesh/eym_format.h).

invariant gl_Position;

layout(location = 0) in uvec2 packedPosition;
layout(location = 1) in uint packedNormal;
layout(location = 2) in uint packedColour;

uniform mat4 clipFromLattice;    // camera-relative lattice -> clip; one for all nodes
uniform mat3 metresFromLattice;  // lattice steps -> metres along shading axes
uniform ivec3 cameraLattice;     // the lattice point the camera snapped to

out vec3 relativeMetres;
out vec3 objectNormal;
out vec3 albedo;

// Meyer et al. 2010, "On Floating-Point Normal Vectors".
vec3 octahedralNormal(vec2 e) {
    vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    if (n.z < 0.0)
        n.xy = (1.0 - abs(n.yx)) * vec2(n.x >= 0.0 ? 1.0 : -1.0, n.y >= 0.0 ? 1.0 : -1.0);
    return normalize(n);
}

void main() {
    ivec3 lattice = ivec3(packedPosition.x & 0x1FFFFFu,
                          (packedPosition.x >> 21) | ((packedPosition.y & 0x3FFu) << 11),
                          (packedPosition.y >> 10) & 0x1FFFFFu);
    // Integers, exact below 2^24: the same vertex has the same bits in every node and process.
    vec3 relative = vec3(lattice - cameraLattice);
    gl_Position = clipFromLattice * vec4(relative, 1.0);
    relativeMetres = metresFromLattice * relative;
    objectNormal = octahedralNormal(unpackSnorm2x16(packedNormal));
    vec3 encoded = unpackUnorm4x8(packedColour).rgb;
    albedo = encoded * encoded;
}
