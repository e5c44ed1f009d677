// Photons at the surfaces they hit: those at diffuse ones are kept for the map, and Russian roulette absorbs them or
// sends them on, a number of bounces or to their ends. When few are left, many bounces in one dispatch cost less than a
// dispatch each.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "common.glsl"
#include "compaction.glsl"
#include "density.glsl"
#include "directions.glsl"
#include "feature_checks.glsl"
#include "material.glsl"
#include "media.glsl"
#include "offset.glsl"
#include "random.glsl"
#include "sampling.glsl"
#include "shared_paths.h"
#include "shared_photons.h"
#include "shared_scene.h"
#include "surface.glsl"
#include "terminator.glsl"
#include "trace_path.glsl"

ARGS(ScatterArgs)

const uint OUTCOME_ESCAPED = 0u;
const uint OUTCOME_ABSORBED = 1u;
const uint OUTCOME_GOES_ON = 2u;

// Goes on with a probability, and makes up for it (Arvo & Kirk 1990).
bool russianRoulette(inout Path path, vec3 color, float probability, float u) {
    if (u >= probability) return false;
    path.throughput *= color / probability;
    return true;
}

uint scatterAtSpecular(uint bounce, inout Path path, Material material, Surface surface, Sampler s) {
    vec2 u = sample2(s, 4u * bounce + 5u);
    vec2 place = hasGlossy && isGlossy(material) ? sample2(s, 4u * bounce + 6u) : vec2(0.0);
    uint run = specularRun(path.flags);
    Interface at = Interface(path.media, NONE);
    if (hasMedia) at = atInterface(args.scene.at[0], path, surface, material);
    bool mapped = isMapped(surface);
    float accepted = mapped ? sample2(s, 4u * bounce + 7u).x : 0.0;
    Scattering event = scatterSpecular(material, surface, path.direction, vec3(u.x, place), accepted);
    uint media = goesBeyond(surface, path.direction, event.direction) ? at.media : path.media;
    float correction =
        mapped ? 1.0 : specularCorrection(-path.direction, event.direction, event.normal, surface.normal);
    vec3 origin =
        hasTouching ? leaveInterface(args.scene.at[0], surface, at, event.direction) : leave(surface, event.direction);
    path = Path(origin, event.direction, path.throughput * correction, 0.0, surface.primitive,
                afterSpecular(path.flags), media);
    return russianRoulette(path, event.weight, specularSurvival(event.weight, run, false), u.y) ? OUTCOME_GOES_ON
                                                                                                : OUTCOME_ABSORBED;
}

// The photon as the map keeps it, seen from the side of `normal`, where the surface has `bulge`. Its flux makes up for
// a shading normal that is not the geometric one (Veach 1997, eq. 5.19).
Photon photonAt(inout Path path, Surface surface, vec3 normal, float bulge) {
    if (hasSmoothNormals) {
        vec3 shading = dot(surface.normal, normal) < 0.0 ? -surface.shading : surface.shading;
        if (bulge == 0.0) path.throughput *= max(0.0, dot(path.direction, shading) / dot(path.direction, normal));
        else
            path.throughput *=
                cosineOfArrival(-path.direction, normal, shading, bulge) / abs(dot(path.direction, normal));
    }
    return Photon(surface.position, path.throughput, packUnit(normal), packUnit(-path.direction));
}

uint scatterAtDiffuse(uint bounce, inout Path path, Material material, Surface surface, vec3 normal, float survival,
                      Sampler s) {
    if (!russianRoulette(path, material.color, survival, sample2(s, 4u * bounce + 5u).y)) return OUTCOME_ABSORBED;
    vec3 direction = toWorld(cosineHemisphere(sample2(s, 4u * bounce + 6u)), normal);
    path = Path(offsetPoint(surface.position, surface.magnitude, normal), direction, path.throughput, 0.0,
                surface.primitive, path.flags & ~PATH_SPECULARS, path.media);
    return OUTCOME_GOES_ON;
}

// A photon that comes to lie on a smooth mesh is one that lies where it leaves the mesh too, if its path would go on:
// there light arrives that the triangles before keep away. Those that the first place absorbs stand for all.
const float MOST_SURVIVAL = 0.8; // some always go through

// At a diffuse surface; a photon may arrive there, as `photon`, and the path goes on with the outcome returned.
uint arriveAtDiffuse(uint bounce, inout Path path, Material material, Surface surface, Sampler s, out Photon photon) {
    bool through = hasSmoothDiffuse && (path.flags & PATH_THROUGH) != 0u;
    bool behind = dot(path.direction, surface.normal) > 0.0;
    vec3 normal = behind != through ? -surface.normal : surface.normal;
    float bulge = bulgeOn(surface, behind != through);
    photon = Photon(vec3(0.0), vec3(0.0), 0u, 0u);
    if (through && bulge <= 0.0) return OUTCOME_ABSORBED;
    path.flags &= ~PATH_THROUGH;

    Path passing = path;
    photon = photonAt(path, surface, normal, bulge);
    if (maxComponent(photon.color) > 0.0) path.flags += 1u << PATH_DIFFUSE_SHIFT;
    else if (through) return OUTCOME_ABSORBED;
    float survival = maxComponent(material.color);
    bool passes = hasSmoothDiffuse && bulge != 0.0 && !through && !isMapped(surface);
    if (passes) survival = min(survival, MOST_SURVIVAL);
    if (args.caustic != 0u) survival = 0.0;
    uint outcome =
        args.caustic != 0u ? OUTCOME_ABSORBED : scatterAtDiffuse(bounce, path, material, surface, normal, survival, s);
    if (!passes || outcome == OUTCOME_GOES_ON) return outcome;
    path = Path(leave(surface, passing.direction), passing.direction, passing.throughput / (1.0 - survival), 0.0,
                surface.primitive, path.flags | PATH_THROUGH, path.media);
    return OUTCOME_GOES_ON;
}

// A photon of caustics where a wide lobe ends it.
Photon photonAtWide(Path path, Surface surface, Material material) {
    bool inside = dot(path.direction, surface.normal) > 0.0;
    vec3 normal = inside ? -surface.normal : surface.normal, color = path.throughput;
    if (args.connected != 0u) {
        float arrived = abs(dot(path.direction, normal));
        return Photon(surface.position, color / max(arrived, 1e-6), packUnit(-path.direction), 0u);
    }
    if (hasWideGlass && isRoughGlass(material)) color = markedOnGlass(color, inside);
    return Photon(surface.position, color, packUnit(normal), packUnit(-path.direction));
}

// At a surface with a diffuse lobe and a glossy one. The photon arrives at the diffuse one before it takes either, or
// neither, in proportion to what they reflect; photons of caustics take the glossy one alone, and have to arrive by
// one.
uint arriveAtLayers(uint bounce, inout Path path, Material material, Surface surface, Sampler s, out Photon photon) {
    DeviceScene scene = args.scene.at[0];
    bool behind = dot(path.direction, surface.normal) > 0.0;
    vec3 geometric = behind ? -surface.normal : surface.normal;
    float cosine = -dot(path.direction, scatteringNormal(surface, path.direction));
    bool mapped = isMapped(surface);
    bool aimed = args.caustic != 0u && specularRun(path.flags) == 0u;
    bool ends = args.caustic != 0u && isWide(material);
    photon = Photon(vec3(0.0), vec3(0.0), 0u, 0u);
    Path base = path;
    if (hasWide && ends && args.connected != 0u) {
        photon = photonAtWide(path, surface, material);
        return OUTCOME_ABSORBED;
    }
    if (!aimed) {
        photon = photonAt(base, surface, geometric, 0.0);
        if (mapped)
            photon.color = path.throughput *
                           weightOfArrival(scene, material, -path.direction, geometric,
                                           behind ? -surface.shading : surface.shading, -1.0) /
                           max(abs(dot(path.direction, geometric)), 1e-6);
        else photon.color *= diffuseArrival(scene, material, cosine);
        if (maxComponent(photon.color) > 0.0) path.flags += 1u << PATH_DIFFUSE_SHIFT;
    }
    vec3 albedo = diffuseAlbedo(scene, material, cosine);
    float diffuse = args.caustic != 0u ? 0.0 : maxComponent(albedo);
    float glossy = aimed ? 1.0 : maxComponent(glossyAlbedo(material, cosine, restAt(scene, material, cosine)));
    glossy *= runSurvival(specularRun(path.flags), false);
    if (ends) glossy = 0.0;

    float u = sample2(s, 4u * bounce + 5u).x;
    vec2 place = sample2(s, 4u * bounce + 6u);
    if (u < glossy) {
        Scattering event;
        float correction = 1.0;
        if (mapped) {
            float accepted = sample2(s, 4u * bounce + 7u).x;
            event = scatterMapped(material, surface, path.direction, vec3(0.0, place), accepted);
        } else {
            event = scatterGlossy(material, surface, path.direction, vec3(0.0, place));
            correction = specularCorrection(-path.direction, event.direction, event.normal, surface.normal);
        }
        path =
            Path(leave(surface, event.direction), event.direction, path.throughput * event.weight * correction / glossy,
                 0.0, surface.primitive, afterSpecular(path.flags), path.media);
        return maxComponent(path.throughput) > 0.0 ? OUTCOME_GOES_ON : OUTCOME_ABSORBED;
    }
    if (u >= glossy + diffuse) return OUTCOME_ABSORBED;
    vec3 direction = toWorld(cosineHemisphere(place), geometric);
    float outgoing = dot(direction, scatteringNormal(surface, -direction));
    vec3 color = base.throughput * albedo * (diffuseArrival(scene, material, outgoing) / diffuse);
    if (mapped) color = photon.color * diffuseAlbedo(scene, material, outgoing) / diffuse;
    path = Path(offsetPoint(surface.position, surface.magnitude, geometric), direction, color, 0.0, surface.primitive,
                path.flags & ~PATH_SPECULARS, path.media);
    return maxComponent(color) > 0.0 ? OUTCOME_GOES_ON : OUTCOME_ABSORBED;
}

// Moves the photon on; returns its outcome, and whether it belongs into the map, as `deposit`.
uint scatterPhoton(uint slot, uint bounce, inout Path path, Hit hit, out bool arrives, out PhotonDeposit deposit) {
    DeviceScene scene = args.scene.at[0];
    arrives = false;
    bool through = hasSmoothDiffuse && (path.flags & PATH_THROUGH) != 0u;
    if (hit.primitive == NONE) return through ? OUTCOME_ABSORBED : OUTCOME_ESCAPED;

    Sampler s = photonSampler(args.firstPhoton + slot, args.pass, args.seed, args.caustic);
    Surface surface = surfaceAt(scene, path, hit);
    if (hasMedia) path.throughput *= transmittance(scene, path.media, hit.t);
    Material material = materialAt(scene, path, surface, hit.weights);
    requireSurface(scene, hit.primitive, material);
    if (hasLayered && material.kind != MATERIAL_DIFFUSE) surface.bulge = 0.0;
    mapNormal(scene, surface, material, hit.weights);
    uint outcome;
    if (hasMedia && !(maxComponent(path.throughput) > 0.0)) return OUTCOME_ABSORBED;
    if (through && (surface.bulge == 0.0 || !isDiffuse(material))) return OUTCOME_ABSORBED;
    if (hasWide && args.caustic != 0u && isWide(material) && (path.flags & PATH_SPECULARS) == 0u)
        return OUTCOME_ESCAPED; // aimed at a narrow lobe, but it has another
    if (hasLayered && material.kind != MATERIAL_DIFFUSE && isDiffuse(material)) {
        uint index = path.flags >> PATH_DIFFUSE_SHIFT;
        Photon photon;
        outcome = arriveAtLayers(bounce, path, material, surface, s, photon);
        arrives = maxComponent(photon.color) > 0.0;
        deposit = PhotonDeposit(photon, slot, index);
    } else if (!isDiffuse(material)) {
        bool ends = args.caustic != 0u && isWide(material);
        if (ends && showsPhotons(material)) {
            deposit = PhotonDeposit(photonAtWide(path, surface, material), slot, 0u);
            arrives = maxComponent(path.throughput) > 0.0;
        }
        outcome = ends ? OUTCOME_ABSORBED : scatterAtSpecular(bounce, path, material, surface, s);
    } else if (args.caustic != 0u && (path.flags & PATH_SPECULARS) == 0u) {
        return OUTCOME_ESCAPED; // aimed at a specular shape, but not one that it hit
    } else {
        uint index = path.flags >> PATH_DIFFUSE_SHIFT;
        Photon photon;
        outcome = arriveAtDiffuse(bounce, path, material, surface, s, photon);
        arrives = maxComponent(photon.color) > 0.0;
        deposit = PhotonDeposit(photon, slot, index);
    }
    // Of a surface that stops a part alone, or is glass in part, the eye sees as much; what it sees is lit by all of
    // the light.
    if (hasOpacity && arrives && material.seeThrough > 0.0)
        deposit.photon.color /= max(opacityAt(scene, material, hit.primitive, hit.weights, surface.position), 1e-6);
    if (hasMixed && arrives) deposit.photon.color /= max(1.0 - material.transmission, 1e-6);
    return outcome;
}

// Keeps a deposit, in any order; (slot, index) says where it belongs. One atomic each: to share one takes several
// operations on a subgroup whose lanes nothing keeps together in between.
void keep(PhotonDeposit deposit) {
    uint place = atomicAdd(args.status.at[0].deposits, 1u);
    args.counts.at[deposit.slot] = deposit.index + 1u;
    if (place < args.capacity) args.deposits.at[place] = deposit;
}

// The ledger; sums of integers depend neither on their order nor on which lanes are together.
void count(uint outcome, uint rays) {
    uint escaped = subgroupAdd(uint(outcome == OUTCOME_ESCAPED));
    uint absorbed = subgroupAdd(uint(outcome == OUTCOME_ABSORBED));
    uint traced = subgroupAdd(rays);
    if (subgroupElect()) {
        if (escaped > 0u) atomicAdd(args.status.at[0].escaped, escaped);
        if (absorbed > 0u) atomicAdd(args.status.at[0].absorbed, absorbed);
        atomicAdd(args.status.at[0].rays, traced);
    }
}

void main() {
    Queue queue = args.queue.at[0];
    uint place = threadIndex();
    if (place >= queue.count) return;

    uint slot = args.list.at[queue.first + place];
    Path path = args.paths.at[slot];
    uint outcome = OUTCOME_GOES_ON, rays = 0u;
    while (outcome == OUTCOME_GOES_ON && rays < args.bounces) {
        Hit hit = tracePath(args.scene.at[0], path);
        bool arrives;
        PhotonDeposit deposit;
        outcome = scatterPhoton(slot, args.bounce + rays, path, hit, arrives, deposit);
        if (arrives) keep(deposit);
        rays++;
    }
    if (outcome == OUTCOME_GOES_ON) args.paths.at[slot] = path;
    putFlags(args.flags, place, PHOTON_QUEUES, uint(outcome == OUTCOME_GOES_ON) << QUEUE_CONTINUE);
    count(outcome, rays);
}
