#version 450 core
// SPDX-License-Identifier: Apache-2.0
// Terrain tile: packed 32- or 64-bit vertices on the data set's integer lattice (terrain/eyt_format.h).

invariant gl_Position;

layout(location = 0) in uvec2 packedVertex;

uniform mat4 clipFromLattice;    // camera-relative lattice -> clip; one for all tiles
uniform mat3 metresFromLattice;  // lattice steps -> metres along shading axes
uniform ivec3 cameraLattice;     // the lattice point the camera snapped to
uniform ivec3 tileOrigin;        // lattice point of the tile's first post; z its base height
uniform int spacingShift;        // samples of the tile's level are 2^spacingShift posts apart
uniform int heightMultiplier;    // lattice height steps of one packed step
uniform ivec2 lastPost;          // posts past the data's edge sit on it
uniform float lowestHeight;      // of the data set, in lattice height steps
uniform float bandsPerHeight;    // bands of elevation in one lattice height step
uniform sampler2D normalMap;

out vec2 normalMapCoordinate;
out vec3 relativeMetres;
out float band;

void main() {
    uint word = packedVertex.x;
    ivec2 halfSteps = ivec2(word & 1023u, (word >> 10) & 1023u);
    int heightSteps = int((word >> 20) + packedVertex.y);
    ivec2 post = min(tileOrigin.xy + ((halfSteps << spacingShift) >> 1), lastPost);
    ivec3 lattice = ivec3(post, tileOrigin.z + heightSteps * heightMultiplier);

    // Integers, exact below 2^24: the same border vertex has the same bits in every tile.
    vec3 relative = vec3(lattice - cameraLattice);
    gl_Position = clipFromLattice * vec4(relative, 1.0);

    relativeMetres = metresFromLattice * relative;
    band = (float(lattice.z) - lowestHeight) * bandsPerHeight;
    vec2 texel = vec2(post - tileOrigin.xy) / float(1 << spacingShift) + 0.5;
    normalMapCoordinate = texel / vec2(textureSize(normalMap, 0));
}
