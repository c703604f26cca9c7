in vec2 normalMapCoordinate;
in vec3 relativeMetres;
in float band;  // of elevation: 0 at the lowest of the data set, 5 at the highest

uniform sampler2D normalMap;  // x and y of the object-space normal

out vec4 colour;

const vec3 kMeadow = vec3(0.12, 0.19, 0.06);
const vec3 kForest = vec3(0.07, 0.14, 0.05);
const vec3 kScrub = vec3(0.22, 0.21, 0.09);
const vec3 kRock = vec3(0.25, 0.19, 0.13);
const vec3 kScree = vec3(0.34, 0.31, 0.28);
const vec3 kSnow = vec3(0.86, 0.89, 0.93);

// Hypsometric tints, linear light. Summed rather than looked up: software renderers gather a
// computed index lane by lane.
vec3 tint(float slope) {
    vec3 tinted = kMeadow + (kForest - kMeadow) * clamp(band, 0.0, 1.0) +
                  (kScrub - kForest) * clamp(band - 1.0, 0.0, 1.0) +
                  (kRock - kScrub) * clamp(band - 2.0, 0.0, 1.0) +
                  (kScree - kRock) * clamp(band - 3.0, 0.0, 1.0) +
                  (kSnow - kScree) * clamp(band - 4.0, 0.0, 1.0);
    // Steep ground sheds soil and snow: show rock.
    return mix(tinted, vec3(0.17, 0.15, 0.13), clamp(slope * 2.2 - 1.0, 0.0, 0.75));
}

void main() {
    vec3 objectNormal;
    objectNormal.xy = textureLod(normalMap, normalMapCoordinate, 0.0).xy;
    objectNormal.z = sqrt(max(1.0 - dot(objectNormal.xy, objectNormal.xy), 0.0));
    vec3 normal = shadingNormal(objectNormal);
#if FLAT
    vec3 facet = normalize(cross(dFdx(relativeMetres), dFdy(relativeMetres)));
    normal = dot(facet, normal) < 0.0 ? -facet : facet;
#endif
    colour = display(tint(1.0 - objectNormal.z) * diffuseLight(normal) * 1.35);
}
