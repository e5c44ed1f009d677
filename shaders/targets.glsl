// Aiming photons at the bounding spheres of specular shapes (the projection map of Jensen & Christensen 1995).

// Solid angle that a target gets: that of its cone, or the hemisphere for a point inside it.
float targetSolidAngle(Target target, vec3 point) {
    vec3 d = target.center - point;
    float distance2 = dot(d, d);
    if (distance2 <= target.radius * target.radius) return 2.0 * PI;
    return 2.0 * PI * coneHeight(target.radius, distance2);
}

// Density over solid angle with which a target sends a direction, times its solid angle; a direction that was
// sampled from the target is within its cone, whatever rounding says.
float targetDensity(Target target, LightPoint point, vec3 direction, bool sampled) {
    vec3 d = target.center - point.position;
    float distance2 = dot(d, d);
    if (distance2 <= target.radius * target.radius) return 2.0 * max(0.0, dot(direction, point.normal));
    vec3 across = cross(d, direction);
    return sampled || (dot(d, direction) > 0.0 && dot(across, across) <= target.radius * target.radius) ? 1.0 : 0.0;
}

vec3 sampleTarget(Target target, LightPoint point, vec2 u) {
    vec3 d = target.center - point.position;
    float distance2 = dot(d, d);
    if (distance2 <= target.radius * target.radius) return toWorld(cosineHemisphere(u), point.normal);
    return toWorld(uniformCone(u, coneHeight(target.radius, distance2)), d * inversesqrt(distance2));
}

// A direction of a photon for the global map: by the cosine law or, from where it would hardly ever meet anything, uniform over
// the cone of all that light falls upon. The weight is the cosine law over that density, 0 below the horizon.
float aimAtLit(DeviceScene scene, LightPoint point, vec2 u, out vec3 direction) {
    vec3 d = scene.lit.center - point.position;
    float distance2 = dot(d, d);
    bool far = distance2 > 4.0 * scene.lit.radius * scene.lit.radius;
    if (checksFeatures != 0u) require(scene, far, hasFarLights, id_hasFarLights);
    if (hasFarLights == 0u || !far) {
        direction = toWorld(cosineHemisphere(u), point.normal);
        return 1.0;
    }
    float height = coneHeight(scene.lit.radius, distance2);
    direction = toWorld(uniformCone(u, height), d * inversesqrt(distance2));
    return 2.0 * height * max(0.0, dot(direction, point.normal));
}

// Chooses a target in proportion to its solid angle and a direction within it. The weight is the cosine law over the
// density of the mixture, so a direction covered by several targets counts once; 0 if it is below the horizon.
float aimAtTargets(DeviceScene scene, LightPoint point, vec2 u, float choice, out vec3 direction) {
    direction = point.normal;
    if (scene.targetCount == 0u) return 0.0;
    float total = 0.0;
    for (uint i = 0u; i < scene.targetCount; i++) total += targetSolidAngle(TargetPtr(scene.targets).at[i], point.position);
    uint chosen = 0u;
    float left = choice * total - targetSolidAngle(TargetPtr(scene.targets).at[0], point.position);
    while (left >= 0.0 && chosen + 1u < scene.targetCount) left -= targetSolidAngle(TargetPtr(scene.targets).at[++chosen], point.position);

    direction = sampleTarget(TargetPtr(scene.targets).at[chosen], point, u);
    float density = 0.0;
    for (uint i = 0u; i < scene.targetCount; i++) density += targetDensity(TargetPtr(scene.targets).at[i], point, direction, i == chosen);
    float cosine = dot(direction, point.normal);
    return cosine > 0.0 ? cosine / PI * total / density : 0.0;
}
