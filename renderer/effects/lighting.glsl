// SPDX-License-Identifier: Apache-2.0
// Lights of a scene. Colours here are linear; the display's transfer function is taken as a square.

uniform int lightCount;
uniform vec3 lightDirections[4];  // towards the light, world axes, unit
uniform vec3 lightColours[4];
uniform float ambient;

vec3 diffuseLight(vec3 normal) {
    vec3 light = vec3(ambient);
    for (int i = 0; i < lightCount; ++i)
        light += lightColours[i] * max(dot(normal, lightDirections[i]), 0.0) * (1.0 - ambient);
    return light;
}

float specularLight(vec3 normal, vec3 towardsEye, float exponent) {
    float light = 0.0;
    for (int i = 0; i < lightCount; ++i)
        light += pow(max(dot(normal, normalize(lightDirections[i] + towardsEye)), 0.0), exponent);
    return light;
}

vec4 display(vec3 linear) { return vec4(sqrt(clamp(linear, 0.0, 1.0)), 1.0); }
