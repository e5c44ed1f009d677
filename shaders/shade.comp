// Eye paths at the surfaces they hit: light that is seen, and what to ask of shadow rays and photon maps.
//
// The photon integrator asks at the first diffuse vertex for the caustic map, splits the path there (see split.comp),
// and asks for the global map where gather rays end. The path integrator goes on and on, and counts the same paths in
// the same layers.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "direct.glsl"
#include "directions.glsl"
#include "feature_checks.glsl"
#include "film_layout.glsl"
#include "light.glsl"
#include "material.glsl"
#include "offset.glsl"
#include "random.glsl"
#include "sampling.glsl"
#include "shared_camera.h"
#include "shared_film.h"
#include "shared_layers.h"
#include "shared_paths.h"
#include "shared_scene.h"
#include "surface.glsl"
#include "terminator.glsl"

ARGS(ShadeArgs)

uint activeIntegrator() { return integrator == ANY ? args.integrator : integrator; }

bool showsCaustics() { return hasCausticMap && args.caustics != 0u; }

// A pixel's seed for the dimensions of this bounce: four pairs each, after that of the place in the pixel.
vec2 bounceSample(Sampler s, uint pair) { return sample2(s, 4u * args.bounce + pair + 1u); }

// The layer of a path, by the name it has if no specular surface stands before the first diffuse one.
uint layerOf(Path path, uint layer) { return (path.flags & PATH_EYE_SPECULAR) != 0u ? LAYER_SPECULAR : layer; }

// Light that the path runs into: seen directly or through specular surfaces. After a diffuse vertex the shadow rays
// have the direct part, and the photon integrator has the rest in its maps.
void addEmission(uint slot, Path path, Light light, vec3 normal) {
    uint diffuse = path.flags >> PATH_DIFFUSE_SHIFT;
    if (diffuse > 0u && (activeIntegrator() != INTEGRATOR_PATH || (path.flags & PATH_SPECULARS) == 0u)) return;
    uint layer = layerOf(path, diffuse == 0u ? LAYER_EMISSION : diffuse == 1u ? LAYER_CAUSTIC : LAYER_INDIRECT);
    if (!hasLayer(layer)) return;
    addToColumns(args.samples, args.stride, layerColumn(layer), slot,
                 path.throughput * emittedRadiance(light, normal, -path.direction));
}

// Asks for one light sample.
bool requestShadowRay(DeviceScene scene, uint slot, Path path, Surface surface, vec3 normal, vec3 shading, float bulge,
                      vec3 weight, Sampler s) {
    uint layer = layerOf(path, path.flags >> PATH_DIFFUSE_SHIFT == 0u ? LAYER_DIRECT : LAYER_INDIRECT);
    if (!hasLayer(layer)) return false;
    vec3 origin = offsetPoint(surface.position, surface.magnitude, normal);
    ShadowRay ray = sampleDirect(scene, origin, surface.primitive, normal, shading, bulge, weight, layerColumn(layer),
                                 bounceSample(s, 0u), bounceSample(s, 1u));
    args.shadowRays.at[slot] = ray;
    return maxComponent(ray.radiance) > 0.0;
}

// Returns the bit of the map's queue, or none if there is no such map or nobody asked for the layer.
uint queryPhotonMap(uint queue, uint slot, Path path, Surface surface, vec3 normal, vec3 weight, uint layer) {
    layer = layerOf(path, layer);
    if (!(queue == QUEUE_GLOBAL ? hasGlobalMap : hasCausticMap) || !hasLayer(layer)) return 0u;
    float footprint = path.distanceSinceDiffuse * args.pixelAngle;
    args.queries.at[slot] = Query(surface.position, normal, weight, layerColumn(layer), footprint);
    return 1u << queue;
}

// Lets light samples and gather rays start here, if anyone asks for what they find.
void storeSplit(uint slot, Path path, Surface surface, vec3 normal, vec3 shading, float bulge, vec3 weight) {
    if (!(hasDirectLayer || hasSpecularLayer || hasIndirectLayer) || maxComponent(weight) <= 0.0) return;
    uint flags = (path.flags & PATH_EYE_SPECULAR) | 1u << PATH_DIFFUSE_SHIFT;
    args.splits.at[slot] = Split(offsetPoint(surface.position, surface.magnitude, normal), normal, shading, weight,
                                 surface.primitive, flags, bulge);
}

// Whether light that is found beyond a diffuse vertex has a layer to go to.
bool continuesAfterDiffuse(Path path) {
    if (activeIntegrator() == INTEGRATOR_DIRECT) return false;
    if ((path.flags & PATH_EYE_SPECULAR) != 0u) return hasSpecularLayer;
    return hasIndirectLayer ||
           (activeIntegrator() == INTEGRATOR_PATH && hasCausticLayer && path.flags >> PATH_DIFFUSE_SHIFT == 0u);
}

// One diffuse bounce, cosine distributed about the shading normal; Russian roulette from the third diffuse vertex on.
bool bounceDiffuse(inout Path path, Surface surface, vec3 normal, vec3 shading, float bulge, vec3 albedo, Sampler s) {
    uint diffuse = (path.flags >> PATH_DIFFUSE_SHIFT) + 1u;
    float survival = diffuse > 2u ? maxComponent(albedo) : 1.0;
    if (maxComponent(albedo) <= 0.0 || bounceSample(s, 2u).x >= survival) return false;
    vec3 direction = toWorld(cosineHemisphere(bounceSample(s, 3u)), shading);
    if (!departs(direction, normal, bulge)) return false;
    uint flags = (path.flags & PATH_EYE_SPECULAR) | diffuse << PATH_DIFFUSE_SHIFT;
    if (goesThrough(direction, normal, bulge)) flags |= PATH_THROUGH;
    path = Path(offsetPoint(surface.position, surface.magnitude, normal), direction,
                path.throughput * albedo / survival, 0.0, surface.primitive, flags);
    return true;
}

bool scatterAtSpecular(inout Path path, Material material, Surface surface, float distanceSinceDiffuse, Sampler s) {
    vec2 u = bounceSample(s, 0u);
    Scattering event = scatterSpecular(material, surface, path.direction, u.x);
    uint run = specularRun(path.flags);
    float survival = run < 8u ? 1.0 : specularSurvival(event.weight, run);
    if (u.y >= survival) return false;
    uint flags = afterSpecular(path.flags) | (path.flags >> PATH_DIFFUSE_SHIFT == 0u ? PATH_EYE_SPECULAR : 0u);
    vec3 throughput = path.throughput * event.weight * (event.radianceScale / survival);
    path = Path(leave(surface, event.direction), event.direction, throughput, distanceSinceDiffuse, surface.primitive,
                flags);
    return maxComponent(throughput) > 0.0;
}

// At a diffuse surface: returns the queues that the path goes to.
uint shadeDiffuse(DeviceScene scene, uint slot, inout Path path, Surface surface, vec3 albedo, Sampler s) {
    bool behind = dot(path.direction, surface.normal) > 0.0;
    vec3 normal = behind ? -surface.normal : surface.normal;
    vec3 shading = behind ? -surface.shading : surface.shading;
    float bulge = behind ? -surface.bulge : surface.bulge;
    bool first = path.flags >> PATH_DIFFUSE_SHIFT == 0u;
    vec3 weight = path.throughput * albedo;

    if (activeIntegrator() == INTEGRATOR_PHOTON_MAP) {
        bool caustics = showsCaustics();
        return queryPhotonMap(caustics ? QUEUE_CAUSTIC : QUEUE_GLOBAL, slot, path, surface, normal,
                              path.throughput / PI, caustics ? LAYER_CAUSTIC : LAYER_INDIRECT);
    }
    if (activeIntegrator() == INTEGRATOR_PHOTON && !first && path.distanceSinceDiffuse >= args.nearDistance)
        return queryPhotonMap(QUEUE_GLOBAL, slot, path, surface, normal, weight / PI, LAYER_INDIRECT);

    bool splits = activeIntegrator() == INTEGRATOR_PHOTON && first;
    uint queues = 0u;
    if (!splits && requestShadowRay(scene, slot, path, surface, normal, shading, bulge, weight, s))
        queues |= 1u << QUEUE_SHADOW;
    if (activeIntegrator() == INTEGRATOR_PHOTON && showsCaustics())
        queues |= queryPhotonMap(QUEUE_CAUSTIC, slot, path, surface, normal, weight / PI,
                                 first ? LAYER_CAUSTIC : LAYER_INDIRECT);
    if (splits) storeSplit(slot, path, surface, normal, shading, bulge, weight);
    else if (continuesAfterDiffuse(path) && bounceDiffuse(path, surface, normal, shading, bulge, albedo, s))
        queues |= 1u << QUEUE_CONTINUE;
    return queues;
}

// Whether light that is found beyond a specular vertex has a layer to go to.
bool continuesAfterSpecular(Path path) { return path.flags >> PATH_DIFFUSE_SHIFT > 0u || hasSpecularLayer; }

uint shade(uint slot) {
    DeviceScene scene = args.scene.at[0];
    Path path = args.paths.at[slot];
    Hit hit = args.hits.at[slot];
    if (hit.primitive == NONE) return 0u;
    Surface surface = surfaceAt(scene, path, hit);
    Material material = MaterialPtr(scene.materials).at[surface.material];
    requireSurface(scene, hit.primitive, material);
    if (checksFeatures) require(scene, activeIntegrator() != args.integrator, false, id_integrator);
    float distanceSinceDiffuse = path.distanceSinceDiffuse + hit.t;
    if (args.bounce == 0u) {
        if (hasAlbedo) storeColumns(args.samples, args.stride, COLUMN_ALBEDO, slot, material.color);
        if (hasNormal) storeColumns(args.samples, args.stride, COLUMN_NORMAL, slot, surface.shading);
        if (hasDepth) {
            args.samples.at[COLUMN_DEPTH * args.stride + slot] =
                scene.unit * (hit.t * dot(path.direction, scene.camera.forward));
            args.samples.at[COLUMN_COVERED * args.stride + slot] = 1.0;
        }
    }
    if (hasSmoothDiffuse && (path.flags & PATH_THROUGH) != 0u) {
        if (surface.bulge == 0.0 || !isDiffuse(material)) return 0u;
        args.paths.at[slot] = Path(leave(surface, path.direction), path.direction, path.throughput,
                                   distanceSinceDiffuse, surface.primitive, path.flags & ~PATH_THROUGH);
        return 1u << QUEUE_CONTINUE;
    }
    if (surface.light != NONE && activeIntegrator() != INTEGRATOR_PHOTON_MAP)
        addEmission(slot, path, LightPtr(scene.lights).at[surface.light], surface.normal);

    Sampler s = pixelSampler(args.firstPixel + slot, args.index, args.seed, args.sequence);
    path.distanceSinceDiffuse = distanceSinceDiffuse;
    uint queues;
    if (isDiffuse(material)) queues = shadeDiffuse(scene, slot, path, surface, material.color, s);
    else if (continuesAfterSpecular(path))
        queues = uint(scatterAtSpecular(path, material, surface, distanceSinceDiffuse, s)) << QUEUE_CONTINUE;
    else queues = 0u;
    if ((queues & 1u << QUEUE_CONTINUE) != 0u) args.paths.at[slot] = path;
    return queues;
}

void main() {
    Queue queue = args.queue.at[0];
    uint place = threadIndex();
    if (place < queue.count) args.flags.at[place] = shade(args.list.at[queue.first + place]);
}
