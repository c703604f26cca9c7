in vec3 relativeMetres;
in vec3 objectNormal;
in vec3 albedo;

uniform vec3 cameraOffsetMetres;  // from the snapped camera to the camera, shading axes

out vec4 colour;

void main() {
    vec3 towardsEye = normalize(cameraOffsetMetres - relativeMetres);
#if FLAT
    vec3 normal = normalize(cross(dFdx(relativeMetres), dFdy(relativeMetres)));
#else
    vec3 normal = shadingNormal(normalize(objectNormal));
#endif
    // Scans are open surfaces: both sides are lit.
    if (dot(normal, towardsEye) < 0.0)
        normal = -normal;
    vec3 lit = albedo * diffuseLight(normal) + 0.08 * specularLight(normal, towardsEye, 40.0);
    colour = display(lit);
}
