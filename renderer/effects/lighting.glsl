// SPDX-License-Identifier: Apache-2.0
// Lights of a scene. Colours here are linear; the display's transfer function is taken as a square.

// LIGHTS is defined before this text, for the number of lights that the scene has, and CONFORMAL,
// for an object that is turned and scaled but not sheared. Shading axes are then those of the
// object, so that its normals are right as they come; otherwise those of the world.
uniform vec3 lightDirections[LIGHTS];  // towards the light, shading axes, unit; the first is the key
uniform vec3 lightColours[LIGHTS];
uniform float ambient;

#if CONFORMAL
vec3 shadingNormal(vec3 objectNormal) { return objectNormal; }
#else
uniform mat3 worldFromNormal;  // inverse transpose of world from object
vec3 shadingNormal(vec3 objectNormal) { return normalize(worldFromNormal * objectNormal); }
#endif

vec3 diffuseLight(vec3 normal) {
    vec3 light = vec3(0.0);
    for (int i = 0; i < LIGHTS; ++i)
        light += lightColours[i] * max(dot(normal, lightDirections[i]), 0.0);
    return vec3(ambient) + light * (1.0 - ambient);
}

/// Of the key light alone.
vec3 specularLight(vec3 normal, vec3 towardsEye, float exponent) {
    vec3 halfway = normalize(lightDirections[0] + towardsEye);
    return lightColours[0] * pow(max(dot(normal, halfway), 0.0), exponent);
}

vec4 display(vec3 linear) { return vec4(sqrt(clamp(linear, 0.0, 1.0)), 1.0); }
