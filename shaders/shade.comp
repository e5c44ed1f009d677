// Eye paths at the surfaces they hit: light that is seen, and what to ask of shadow rays and photon maps.
//
// The photon integrator asks at the first diffuse vertex for the caustic map, splits the path there (see split.comp),
// and asks for the global map where gather rays end. The path integrator goes on and on, and counts the same paths in
// the same layers.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "compaction.glsl"
#include "direct.glsl"
#include "directions.glsl"
#include "feature_checks.glsl"
#include "film_layout.glsl"
#include "glint.glsl"
#include "labels.glsl"
#include "lanes.glsl"
#include "light.glsl"
#include "material.glsl"
#include "media.glsl"
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

bool showsCaustics() { return hasCausticMap && (args.mode & SHADE_CAUSTICS) != 0u; }

bool isGatherRay() { return (args.mode & SHADE_GATHER_RAYS) != 0u; }

// The point of a path's sequence, and the bounce that it is at.
struct BounceSampler {
    Sampler path;
    uint bounce;
};

// Two dimensions of a bounce: it has four pairs, after that of the place in the pixel.
vec2 bounceSample(BounceSampler s, uint pair) { return sample2(s.path, 4u * s.bounce + pair + 1u); }

// The layer of a path, by the name it has if no specular surface stands before the first diffuse one.
uint layerOf(Path path, uint layer) { return (path.flags & PATH_EYE_SPECULAR) != 0u ? LAYER_SPECULAR : layer; }

// Where light of a layer that a path finds is added.
uint columnOf(Path path, uint layer) {
    bool gathering =
        activeIntegrator() == INTEGRATOR_PHOTON && diffuseCount(path.flags) > 0u && (!hasWide || isGatherRay());
    return gathering ? COLUMN_GATHERED : layerColumn(layer);
}

// Whether the label of a material's other lobe than the diffuse one is W. Whoever looks at a map sees it through all.
bool isWideHere(Material material) { return isWide(material) && activeIntegrator() != INTEGRATOR_PHOTON_MAP; }

// What a path does at the surface that it hits.
struct Vertex {
    uint queues;         // that it goes to, one bit each
    uint emissionColumn; // to which `emission` is added, or NONE
    vec3 emission;
    uint event;          // of the path that goes on, see labels.glsl
    float asking;        // weight of what is asked of the caustic map; 0: another path of the pixel asks
    Path path;           // of QUEUE_CONTINUE
    ShadowRay shadowRay; // of QUEUE_SHADOW
    Query query;         // of QUEUE_CAUSTIC or QUEUE_GLOBAL
    Split split;         // its flags may be NONE
};

// Whether light that the path runs into counts: seen directly or through specular surfaces. After a diffuse vertex the
// shadow rays have the direct part, and the photon integrator has the rest in its maps; after a wide one there are no
// maps, and the shadow rays share the direct part.
bool findsLight(inout Vertex vertex, Path path) {
    uint diffuse = diffuseCount(path.flags);
    bool narrow = wasNarrow(path.flags), wide = wasWide(path.flags);
    if (diffuse > 0u) {
        if (activeIntegrator() == INTEGRATOR_PATH ? !narrow && !wide : !wide) return false;
        if (activeIntegrator() == INTEGRATOR_DIRECT && narrow) return false;
    }
    uint layer = layerOf(path, diffuse == 0u  ? LAYER_EMISSION
                               : diffuse > 1u ? LAYER_INDIRECT
                               : narrow       ? LAYER_CAUSTIC
                                              : LAYER_DIRECT);
    if (!hasLayer(layer)) return false;
    vertex.emissionColumn = columnOf(path, layer);
    return true;
}

void addEmission(inout Vertex vertex, DeviceScene scene, Path path, Surface surface) {
    if (!findsLight(vertex, path)) return;
    Light light = LightPtr(scene.lights).at[surface.light];
    vertex.emission = path.throughput *
                      emittedRadianceAt(scene, light, LightPoint(surface.position, surface.magnitude, surface.normal),
                                        -path.direction);
    if (hasGlossy)
        vertex.emission *= weightOfLightFound(scene, surface.light, light, path.origin, surface, pdfOf(path.flags));
}

// A light sample comes through the media that it is in.
void attenuateShadowRay(inout Vertex vertex, DeviceScene scene, uint media) {
    if (hasMedia) vertex.shadowRay.radiance *= shadowTransmittance(scene, media, vertex.shadowRay);
}

// The same of the lights that are endlessly far.
void addBeyond(inout Vertex vertex, DeviceScene scene, Path path, uint slot) {
    if (activeIntegrator() == INTEGRATOR_PHOTON_MAP || (hasSmoothDiffuse && (path.flags & PATH_THROUGH) != 0u)) return;
    bool direct = diffuseCount(path.flags) == 0u && (path.flags & PATH_EYE_SPECULAR) == 0u;
    if (hasSky && direct && scene.sky != uvec2(0u) && SkyPtr(scene.sky).at[0].visible == 0u) return;
    // A gather ray carries its share of direct light: splits have the rest, by light samples.
    uint layer = layerOf(path, LAYER_DIRECT);
    bool gathers = !hasWide || isGatherRay();
    if (gathers && diffuseCount(path.flags) == 1u && !wasNarrow(path.flags) && pdfOf(path.flags) > 0.0) {
        if (!hasLayer(layer)) return;
        vertex.emissionColumn = layerColumn(layer);
        path.throughput *= args.splits.at[pixelOfSlot(args.of, slot)].throughput;
        vertex.emission = path.throughput *
                          radianceBeyond(scene, lightGuideAt(scene, path.origin), path.direction, pdfOf(path.flags));
    } else if (findsLight(vertex, path))
        vertex.emission = path.throughput * radianceBeyond(scene, UNGUIDED, path.direction, pdfOf(path.flags));
}

// Asks for one light sample.
void requestShadowRay(inout Vertex vertex, DeviceScene scene, Path path, Surface surface, vec3 normal, vec3 shading,
                      float bulge, vec3 weight, BounceSampler s) {
    uint layer = layerOf(path, diffuseCount(path.flags) == 0u ? LAYER_DIRECT : LAYER_INDIRECT);
    if (!hasLayer(layer)) return;
    vec3 origin = offsetPoint(surface.position, surface.magnitude, normal);
    vertex.shadowRay = sampleDirect(scene, origin, surface.primitive, normal, shading, bulge, weight,
                                    columnOf(path, layer), bounceSample(s, 0u), bounceSample(s, 1u), UNGUIDED, false);
    attenuateShadowRay(vertex, scene, path.media);
    if (maxComponent(vertex.shadowRay.radiance) > 0.0) vertex.queues |= 1u << QUEUE_SHADOW;
}

// Of the paths of a pixel the first asks the caustic map, for all of them.
float weightOfCaustics(uint slot) {
    if (isGatherRay()) return 1.0;
    return pathOfSlot(args.of, slot) == 0u ? float(args.of.each) : 0.0;
}

// Asks a map, unless there is no such map or nobody asked for the layer.
void queryPhotonMap(inout Vertex vertex, uint queue, Path path, Surface surface, vec3 normal, vec3 weight, uint layer,
                    uint lobes) {
    layer = layerOf(path, layer);
    if (!(queue == QUEUE_GLOBAL ? hasGlobalMap : hasCausticMap) || !hasLayer(layer)) return;
    if (queue == QUEUE_CAUSTIC) {
        bool wandered = hasWide && diffuseCount(path.flags) > 0u; // each path to a place of its own
        float asking = wandered ? 1.0 : vertex.asking;
        if (asking == 0.0) return;
        weight *= asking;
    }
    float footprint = path.distanceSinceDiffuse * args.pixelAngle;
    vertex.query = Query(surface.position, normal, weight, columnOf(path, layer), footprint, surface.primitive, lobes,
                         packUnit(-path.direction));
    vertex.queues |= 1u << queue;
}

// Lets light samples and gather rays start here, if anyone asks for what they find.
void storeSplit(inout Vertex vertex, Path path, Surface surface, vec3 normal, vec3 shading, float bulge, vec3 weight) {
    if (!(hasDirectLayer || hasSpecularLayer || hasIndirectLayer) || maxComponent(weight) <= 0.0) return;
    uint flags = (path.flags & PATH_EYE_SPECULAR) | 1u << PATH_DIFFUSE_SHIFT;
    vertex.split = Split(offsetPoint(surface.position, surface.magnitude, normal), normal, shading, weight,
                         surface.primitive, flags, bulge, path.distanceSinceDiffuse * args.pixelAngle, path.media);
}

// Whether light that is found beyond a diffuse vertex has a layer to go to.
bool continuesAfterDiffuse(Path path) {
    if (activeIntegrator() == INTEGRATOR_DIRECT) return false;
    if ((path.flags & PATH_EYE_SPECULAR) != 0u) return hasSpecularLayer;
    return hasIndirectLayer ||
           (activeIntegrator() == INTEGRATOR_PATH && hasCausticLayer && diffuseCount(path.flags) == 0u);
}

// One diffuse bounce, cosine distributed about the shading normal; Russian roulette from the third diffuse vertex on.
void bounceDiffuse(inout Vertex vertex, DeviceScene scene, Path path, Surface surface, vec3 normal, vec3 shading,
                   float bulge, vec3 albedo, BounceSampler s) {
    float survival = diffuseCount(path.flags) > 1u ? maxComponent(albedo) : 1.0;
    if (maxComponent(albedo) <= 0.0 || bounceSample(s, 2u).x >= survival) return;
    vec3 direction = toWorld(cosineHemisphere(bounceSample(s, 3u)), shading);
    float arrival = diffuseArrivalAt(scene, surface.primitive, surface.position, dot(direction, shading));
    if (!departs(direction, normal, bulge)) return;
    uint flags = afterDiffuse(path.flags);
    if (goesThrough(direction, normal, bulge)) flags |= PATH_THROUGH;
    vertex.path = Path(offsetPoint(surface.position, surface.magnitude, normal), direction,
                       path.throughput * albedo / survival * arrival, 0.0, surface.primitive, flags, path.media);
    vertex.queues |= 1u << QUEUE_CONTINUE;
}

// A light sample for the glossy lobe, unless the maps have that light.
void requestGlossyShadowRay(inout Vertex vertex, DeviceScene scene, Path path, Material material, Surface surface,
                            Interface at, BounceSampler s) {
    uint diffuse = diffuseCount(path.flags);
    bool wide = isWideHere(material);
    if (activeIntegrator() == INTEGRATOR_PHOTON_MAP) return;
    if (diffuse > 0u && activeIntegrator() != INTEGRATOR_PATH && !wide && !wasWide(path.flags)) return;
    uint layer;
    if (wide) layer = layerOf(path, diffuse == 0u ? LAYER_DIRECT : LAYER_INDIRECT);
    else layer = diffuse == 0u ? LAYER_SPECULAR : layerOf(path, diffuse == 1u ? LAYER_CAUSTIC : LAYER_INDIRECT);
    if (!hasLayer(layer)) return;
    bool goesBeyond;
    vertex.shadowRay = sampleDirectGlossy(scene, surface, material, at, -path.direction, path.throughput,
                                          columnOf(path, layer), bounceSample(s, 0u), bounceSample(s, 1u), goesBeyond);
    attenuateShadowRay(vertex, scene, goesBeyond ? at.media : path.media);
    if (maxComponent(vertex.shadowRay.radiance) > 0.0) vertex.queues |= 1u << QUEUE_SHADOW;
}

// Asks for caustics that a wide lobe shows, alone or beside the diffuse one: rays would find the lamp beyond glass by
// luck alone. Returns whether photons have them.
bool askForCaustics(inout Vertex vertex, Path path, Material material, Surface surface, uint lobes) {
    if (!showsPhotons(material) || activeIntegrator() != INTEGRATOR_PHOTON || !showsCaustics()) return false;
    bool inside = dot(path.direction, surface.normal) > 0.0;
    vec3 normal = inside ? -surface.normal : surface.normal;
    if (hasWideGlass && isRoughGlass(material)) lobes |= BY_GLASS | (inside ? BY_INSIDE : 0u);
    queryPhotonMap(vertex, QUEUE_CAUSTIC, path, surface, normal, path.throughput,
                   diffuseCount(path.flags) == 0u ? LAYER_CAUSTIC : LAYER_INDIRECT, lobes);
    return true;
}

void scatterAtSpecular(inout Vertex vertex, DeviceScene scene, Path path, Material material, Surface surface,
                       bool asked, bool lit, BounceSampler s) {
    Interface at = Interface(path.media, NONE);
    if (hasMedia) at = atInterface(scene, path, surface, material);
    vec2 u = bounceSample(s, 0u);
    vec2 place = vec2(0.0);
    if (hasGlossy && isGlossy(material) && !isPassage(material)) {
        if (!lit) requestGlossyShadowRay(vertex, scene, path, material, surface, at, s);
        u.y = bounceSample(s, 2u).x;
        place = bounceSample(s, 3u);
    }
    asked = asked || askForCaustics(vertex, path, material, surface, BY_WIDE);
    // At the first few vertices alone: each choice may double the weight of what goes on.
    if (diffuseCount(path.flags) == 0u && specularRun(path.flags) < 4u && activeIntegrator() != INTEGRATOR_PHOTON_MAP)
        path.throughput *= chooseGlint(scene, material, surface, path.direction, u.x);
    float accepted = isMapped(surface) ? bounceSample(s, 1u).x : 0.0;
    Scattering event = scatterSpecular(material, surface, path.direction, vec3(u.x, place), accepted);
    uint media = goesBeyond(surface, path.direction, event.direction) ? at.media : path.media;
    uint run = specularRun(path.flags);
    float survival = run < 8u ? 1.0 : specularSurvival(event.weight, run, diffuseCount(path.flags) > 0u);
    if (u.y >= survival) return;
    bool wide = isWideHere(material);
    vec3 throughput = path.throughput * event.weight * (event.radianceScale / survival);
    if (!(maxComponent(throughput) > 0.0)) return;
    vec3 origin = hasTouching ? leaveInterface(scene, surface, at, event.direction) : leave(surface, event.direction);
    vertex.path = Path(origin, event.direction, throughput, wide ? 0.0 : path.distanceSinceDiffuse, surface.primitive,
                       withPdf(afterLobe(path.flags, wide) | (asked ? PATH_ASKED : 0u), event.pdf), media);
    vertex.queues |= 1u << QUEUE_CONTINUE;
    bool through = dot(path.direction, surface.normal) > 0.0 == dot(event.direction, surface.normal) > 0.0;
    vertex.event = hasGlossy && isGlossy(material) ? EVENT_GLOSSY : through ? EVENT_WENT_THROUGH : EVENT_REFLECTED;
}

// Whether the global map answers at a diffuse vertex: where gather rays end, unless that is so near that all they bring
// hangs on a few photons.
bool isFar(Path path) {
    return activeIntegrator() == INTEGRATOR_PHOTON && diffuseCount(path.flags) > 0u &&
           path.distanceSinceDiffuse >= args.nearDistance;
}

// `asked`: the caustics are asked for.
void shadeDiffuse(inout Vertex vertex, DeviceScene scene, Path path, Surface surface, vec3 albedo, bool asked,
                  BounceSampler s) {
    bool behind = dot(path.direction, surface.normal) > 0.0;
    vec3 normal = behind ? -surface.normal : surface.normal;
    vec3 shading = behind ? -surface.shading : surface.shading;
    float bulge = bulgeOn(surface, behind);
    bool first = diffuseCount(path.flags) == 0u;
    bool maps = activeIntegrator() == INTEGRATOR_PHOTON_MAP, gathers = activeIntegrator() == INTEGRATOR_PHOTON;
    bool far = isFar(path), asksCaustics = !asked && !far && (maps || gathers) && showsCaustics();
    vec3 weight = maps ? path.throughput : path.throughput * albedo;

    if (asksCaustics)
        queryPhotonMap(vertex, QUEUE_CAUSTIC, path, surface, normal, weight / PI,
                       maps || first ? LAYER_CAUSTIC : LAYER_INDIRECT, BY_DIFFUSE);
    else if (maps || far)
        queryPhotonMap(vertex, QUEUE_GLOBAL, path, surface, normal, weight / PI, LAYER_INDIRECT, BY_DIFFUSE);
    if (maps || far) return;

    if (gathers && first) {
        storeSplit(vertex, path, surface, normal, shading, bulge, weight);
        return;
    }
    requestShadowRay(vertex, scene, path, surface, normal, shading, bulge, weight, s);
    if (continuesAfterDiffuse(path)) bounceDiffuse(vertex, scene, path, surface, normal, shading, bulge, albedo, s);
}

// Whether light that is found beyond a vertex of another lobe than the diffuse one has a layer to go to.
bool continuesAfterLobe(Path path, bool wide) {
    bool first = diffuseCount(path.flags) == 0u;
    if (wide && activeIntegrator() == INTEGRATOR_LIGHT) return false;
    if (wide && (path.flags & PATH_EYE_SPECULAR) == 0u)
        return hasIndirectLayer || (first && (hasDirectLayer || hasCausticLayer));
    return !first || hasSpecularLayer;
}

// A path of a slot at the hit of its ray. The first surface that the eye sees goes to the samples.
Vertex shade(uint slot, uint bounce, Path path, Hit hit) {
    Vertex vertex;
    vertex.queues = 0u;
    vertex.emissionColumn = NONE;
    vertex.event = EVENT_REFLECTED;
    vertex.asking = weightOfCaustics(slot);
    vertex.split.flags = NONE;
    if (!hasEndless && hit.primitive == NONE) return vertex;
    DeviceScene scene = args.scene.at[0];
    if (hasEndless && hit.primitive == NONE) {
        addBeyond(vertex, scene, path, slot);
        return vertex;
    }
    Surface surface = surfaceAt(scene, path, hit);
    Material material = materialAt(scene, path, surface, hit.weights);
    requireSurface(scene, hit.primitive, material);
    if (checksFeatures) require(scene, activeIntegrator() != args.integrator, false, id_integrator);
    if (hasLayered && material.kind != MATERIAL_DIFFUSE) surface.bulge = 0.0;
    mapNormal(scene, surface, material, hit.weights);
    path.distanceSinceDiffuse += hit.t;
    if (hasMedia) path.throughput *= transmittance(scene, path.media, hit.t);
    if (bounce == 0u) {
        float share = shareOfEach(args.of);
        if (hasAlbedo && !hasLabels)
            addToColumns(args.samples, args.stride, COLUMN_ALBEDO, slot, share * material.color);
        if (hasNormal) addToColumns(args.samples, args.stride, COLUMN_NORMAL, slot, share * surface.shading);
        if (hasDepth) {
            args.samples.at[COLUMN_DEPTH * args.stride + slot] +=
                share * scene.unit * (hit.t * dot(path.direction, scene.camera.forward));
            args.samples.at[COLUMN_COVERED * args.stride + slot] += share;
        }
    }
    if (hasSmoothDiffuse && (path.flags & PATH_THROUGH) != 0u) {
        if (surface.bulge == 0.0 || !isDiffuse(material)) return vertex;
        vertex.path = Path(leave(surface, path.direction), path.direction, path.throughput, path.distanceSinceDiffuse,
                           surface.primitive, path.flags & ~PATH_THROUGH, path.media);
        vertex.queues = 1u << QUEUE_CONTINUE;
        return vertex;
    }
    if (surface.light != NONE && activeIntegrator() != INTEGRATOR_PHOTON_MAP) addEmission(vertex, scene, path, surface);
    if (hasWide && activeIntegrator() == INTEGRATOR_DIRECT && diffuseCount(path.flags) > 0u) return vertex;

    BounceSampler s =
        BounceSampler(isGatherRay() ? gatherSampler(args.of, slot) : eyeSampler(args.of, slot, SAMPLES_EYE), bounce);
    bool diffuse = isDiffuse(material), continues = continuesAfterLobe(path, isWideHere(material));
    float cosine = hasLayered ? -dot(path.direction, scatteringNormal(surface, path.direction)) : 1.0;
    bool asked = false, lit = false;
    if (hasLayered && diffuse && isSpecular(material)) {
        if (!isFar(path)) asked = askForCaustics(vertex, path, material, surface, BY_DIFFUSE | BY_WIDE);
        // One of the lobes, and a weight that makes up for the choice.
        float glossy = continues ? glossyProbability(scene, material, cosine) : 0.0;
        diffuse = bounceSample(s, 2u).y >= glossy;
        // Where the diffuse lobe sends no shadow ray, the other one has its own whichever is taken: of a lobe that is
        // taken once in twenty times, highlights would be specks.
        lit =
            glossy > 0.0 && activeIntegrator() == INTEGRATOR_PHOTON && (diffuseCount(path.flags) == 0u || isFar(path));
        if (lit) requestGlossyShadowRay(vertex, scene, path, material, surface, Interface(path.media, NONE), s);
        path.throughput /= diffuse ? 1.0 - glossy : glossy;
    }
    if (diffuse) shadeDiffuse(vertex, scene, path, surface, diffuseAlbedo(scene, material, cosine), asked, s);
    else if (continues) scatterAtSpecular(vertex, scene, path, material, surface, asked, lit, s);
    return vertex;
}

void main() {
    Queue queue = args.queue.at[0];
    uint place = threadIndex();
    if (place >= queue.count) return;
    uint slot = args.list.at[queue.first + place];
    Vertex vertex = shade(slot, args.bounce, args.paths.at[slot], args.hits.at[slot]);
    putFlags(args.flags, place, EYE_QUEUES, vertex.queues);
    if (vertex.emissionColumn != NONE) {
        addToColumns(args.samples, args.stride, vertex.emissionColumn, slot, vertex.emission);
        labelLight(args.samples, args.stride, slot, vertex.emissionColumn, vertex.emission, FOUND_LIGHT);
    }
    if (!isGatherRay() && (vertex.queues & 1u << QUEUE_CONTINUE) != 0u)
        addEvent(args.samples, args.stride, slot, vertex.event);
    if ((vertex.queues & 1u << QUEUE_CONTINUE) != 0u) args.paths.at[slot] = vertex.path;
    if ((vertex.queues & 1u << QUEUE_SHADOW) != 0u) args.shadowRays.at[slot] = vertex.shadowRay;
    if ((vertex.queues & (1u << QUEUE_CAUSTIC | 1u << QUEUE_GLOBAL)) != 0u) args.queries.at[slot] = vertex.query;
    if (vertex.split.flags != NONE) args.splits.at[slot] = vertex.split;
}
