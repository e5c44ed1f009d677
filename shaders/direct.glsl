// Direct light at a point of a diffuse surface; needs sampling.glsl, frame.glsl, light.glsl, offset.glsl and features.glsl.

// A point of a light, and the solid angle that it stands for where it is seen from: one over the density over solid angle.
struct SeenPoint {
    LightPoint point;
    float solidAngle;
};

SeenPoint seenUniformlyByArea(Light light, vec3 origin, vec2 u) {
    LightPoint point = sampleLight(light, u);
    vec3 toLight = point.position - origin;
    float distance2 = dot(toLight, toLight);
    return SeenPoint(point, light.area * abs(dot(toLight, point.normal)) * inversesqrt(distance2) / distance2);
}

// Spheres seen from outside: uniform over the cone that they fill (Shirley, Wang & Zimmerman 1996). The point is the nearer one
// on the ray of that direction, put back onto the sphere.
SeenPoint seenUniformlyByAngle(Light light, vec3 origin, vec2 u) {
    vec3 toCenter = light.a - origin;
    float distance2 = dot(toCenter, toCenter);
    float radius = light.u.x;
    float sine2 = radius * radius / distance2;
    float height = sine2 / (1.0 + sqrt(max(0.0, 1.0 - sine2)));
    vec3 w = toWorld(uniformCone(u, height), toCenter * inversesqrt(distance2));
    float along = dot(toCenter, w);
    vec3 across = toCenter - along * w;
    vec3 n = normalize(-across - sqrt(max(0.0, radius * radius - dot(across, across))) * w);
    return SeenPoint(LightPoint(light.a + radius * n, abs(light.a) + radius, n), 2.0 * PI * height);
}

SeenPoint seenPoint(Light light, vec3 origin, vec2 u) {
    vec3 toCenter = light.a - origin;
    bool outside = isSphere(light) && dot(toCenter, toCenter) > light.u.x * light.u.x;
    if (outside) return seenUniformlyByAngle(light, origin, u);
    return seenUniformlyByArea(light, origin, u);
}

// A shadow ray to a point of a light, chosen by flux, and what it brings if nothing is in its way: the radiance that leaves the
// surface times `weight`, which is zero if the light cannot be seen at all. The ray starts at `origin`, on the side of `normal`,
// which is the geometric one.
ShadowRay sampleDirect(DeviceScene scene, vec3 origin, uint from, vec3 normal, vec3 shading, vec3 weight, uint column, vec2 choice, vec2 place) {
    Light light = LightPtr(scene.lights).at[chooseLight(scene, choice.x)];
    requireLight(scene, light);
    SeenPoint seen = seenPoint(light, origin, place);
    vec3 w = normalize(seen.point.position - origin);
    float cosine = dot(w, normal) > 0.0 ? max(0.0, dot(w, shading)) : 0.0;
    vec3 radiance = emittedRadiance(light, seen.point.normal, -w) * (cosine * seen.solidAngle / (PI * light.probability)) * weight;
    vec3 lightSide = dot(w, seen.point.normal) > 0.0 ? -seen.point.normal : seen.point.normal;
    return ShadowRay(origin, from, offsetPoint(seen.point.position, seen.point.magnitude, lightSide), radiance, column);
}
