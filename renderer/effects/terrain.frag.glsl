in vec2 normalMapCoordinate;  // in texels
in vec3 relativeMetres;
in float heightMetres;

uniform sampler2D normalMap;      // x and y of the object-space normal
uniform mat3 worldFromNormal;     // inverse transpose of world from object
uniform vec2 heightRangeMetres;   // lowest and highest of the data set

out vec4 colour;

// Hypsometric tints, linear light: meadow, forest, scrub, rock, scree, snow. Blended in turn rather
// than looked up: software renderers gather a computed index lane by lane.
vec3 tint(float elevation, float slope) {
    float t = clamp(elevation, 0.0, 1.0) * 5.0;
    vec3 tinted = mix(vec3(0.12, 0.19, 0.06), vec3(0.07, 0.14, 0.05), min(t, 1.0));
    tinted = mix(tinted, vec3(0.22, 0.21, 0.09), clamp(t - 1.0, 0.0, 1.0));
    tinted = mix(tinted, vec3(0.25, 0.19, 0.13), clamp(t - 2.0, 0.0, 1.0));
    tinted = mix(tinted, vec3(0.34, 0.31, 0.28), clamp(t - 3.0, 0.0, 1.0));
    tinted = mix(tinted, vec3(0.86, 0.89, 0.93), clamp(t - 4.0, 0.0, 1.0));
    // Steep ground sheds soil and snow: show rock.
    return mix(tinted, vec3(0.17, 0.15, 0.13), clamp(slope * 2.2 - 1.0, 0.0, 0.75));
}

void main() {
    vec3 objectNormal;
    vec2 coordinate = normalMapCoordinate / vec2(textureSize(normalMap, 0));
    objectNormal.xy = textureLod(normalMap, coordinate, 0.0).xy;
    objectNormal.z = sqrt(max(1.0 - dot(objectNormal.xy, objectNormal.xy), 0.0));
    vec3 normal = normalize(worldFromNormal * objectNormal);
#if FLAT
    vec3 facet = normalize(cross(dFdx(relativeMetres), dFdy(relativeMetres)));
    normal = dot(facet, normal) < 0.0 ? -facet : facet;
#endif
    float span = max(heightRangeMetres.y - heightRangeMetres.x, 1.0e-3);
    float elevation = (heightMetres - heightRangeMetres.x) / span;
    colour = display(tint(elevation, 1.0 - objectNormal.z) * diffuseLight(normal) * 1.35);
}
