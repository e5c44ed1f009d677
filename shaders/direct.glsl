// Direct light at a point of a diffuse surface; needs light.glsl, offset.glsl and features.glsl.

// A shadow ray to a point of a light, chosen by flux, uniform over its area, and what it brings if nothing is in its way: the
// radiance that leaves the surface times `weight`, which is zero if the light cannot be seen at all. The ray starts at `origin`,
// on the side of `normal`, which is the geometric one.
ShadowRay sampleDirect(DeviceScene scene, vec3 origin, uint from, vec3 normal, vec3 shading, vec3 weight, uint column, vec2 choice, vec2 place) {
    Light light = LightPtr(scene.lights).at[chooseLight(scene, choice.x)];
    requireLight(scene, light);
    LightPoint point = sampleLight(light, place);
    vec3 toLight = point.position - origin;
    float distance2 = dot(toLight, toLight);
    vec3 w = toLight * inversesqrt(distance2);
    float cosine = dot(w, normal) > 0.0 ? max(0.0, dot(w, shading)) : 0.0;
    vec3 radiance = emittedRadiance(light, point.normal, -w) * (abs(dot(w, point.normal)) * cosine / distance2)
        * (light.area / light.probability) * weight / PI;
    vec3 lightSide = dot(w, point.normal) > 0.0 ? -point.normal : point.normal;
    return ShadowRay(origin, from, offsetPoint(point.position, point.magnitude, lightSide), radiance, column);
}
