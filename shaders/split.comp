// Sends from each diffuse point that the eye sees a light sample and a gather ray, the latter by the cosine law about
// the shading normal. There are several of both for a path from the eye (splitting, Arvo & Kirk 1990), whose own part
// is traced once for all. Further paths of a pixel have a light sample each, and no gather ray: what gather rays bring
// hardly varies, since neighbours share it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "compaction.glsl"
#include "direct.glsl"
#include "directions.glsl"
#include "film_layout.glsl"
#include "lanes.glsl"
#include "media.glsl"
#include "random.glsl"
#include "sampling.glsl"
#include "shared_camera.h"
#include "shared_layers.h"
#include "shared_paths.h"
#include "terminator.glsl"

ARGS(SplitArgs)

bool gathers(Split from) {
    return hasGlobalMap && hasLayer((from.flags & PATH_EYE_SPECULAR) != 0u ? LAYER_SPECULAR : LAYER_INDIRECT);
}

// Of a light sample, and of the gather ray that is sent with it.
float share() { return args.sends == SPLIT_GATHERS ? shareOfEach(args.of) : 1.0; }

bool sendLightSample(uint slot, Split from, Sampler s) {
    uint layer = (from.flags & PATH_EYE_SPECULAR) != 0u ? LAYER_SPECULAR : LAYER_DIRECT;
    if (!hasLayer(layer)) return false;
    ShadowRay ray =
        sampleDirect(args.scene.at[0], from.origin, from.from, from.normal, from.shading, from.bulge,
                     share() * from.throughput, layerColumn(layer), sample2(s, 1u), sample2(s, 2u),
                     lightGuideAt(args.scene.at[0], from.origin), args.sends != SPLIT_GATHERS || gathers(from));
    if (hasMedia) ray.radiance *= shadowTransmittance(args.scene.at[0], from.media, ray);
    args.shadowRays.at[slot] = ray;
    return maxComponent(ray.radiance) > 0.0;
}

// A direction by the cosine law, the part of what arrives there that counts, and whether there is a ray for it.
bool departsByCosineLaw(Split from, Sampler s, out vec3 direction, out float arrival) {
    direction = toWorld(cosineHemisphere(sample2(s, 0u)), from.shading);
    arrival = diffuseArrivalAt(args.scene.at[0], from.from, from.origin, dot(direction, from.shading));
    return departs(direction, from.normal, from.bulge);
}

bool sendGatherRay(uint slot, Split from, Sampler s) {
    vec3 direction;
    float arrival;
    if (!gathers(from) || !departsByCosineLaw(from, s, direction, arrival)) return false;
    uint flags = goesThrough(direction, from.normal, from.bulge) ? from.flags | PATH_THROUGH : from.flags;
    if (hasEndless && (flags & PATH_THROUGH) == 0u) // else light samples have all of the sky
        flags = withPdf(flags, cosineOfArrival(direction, from.normal, from.shading, from.bulge) / PI);
    args.paths.at[slot] = Path(from.origin, direction, vec3(share() * arrival), 0.0, from.from, flags, from.media);
    return true;
}

// In place of the gather ray of the first path: its share of the lights that are endlessly far.
bool sendRayBeyond(uint slot, Split from, Sampler s) {
    DeviceScene scene = args.scene.at[0];
    uint layer = (from.flags & PATH_EYE_SPECULAR) != 0u ? LAYER_SPECULAR : LAYER_DIRECT;
    vec3 direction;
    float arrival;
    if (!hasLayer(layer) || !departsByCosineLaw(from, s, direction, arrival) ||
        goesThrough(direction, from.normal, from.bulge))
        return false;
    float pdf = unpackPdf(packPdf(cosineOfArrival(direction, from.normal, from.shading, from.bulge) / PI));
    vec3 radiance = arrival * from.throughput * radianceBeyond(scene, lightGuideAt(scene, from.origin), direction, pdf);
    ShadowRay ray = ShadowRay(from.origin, from.from, direction, radiance, layerColumn(layer), SHADOW_ENDLESS);
    if (hasMedia) ray.radiance *= shadowTransmittance(scene, from.media, ray);
    args.shadowRays.at[slot] = ray;
    return maxComponent(ray.radiance) > 0.0;
}

uint send(uint slot) {
    bool ofFirst = args.sends == SPLIT_GATHERS; // path of the pixel
    Split from = args.splits.at[ofFirst ? pixelOfSlot(args.of, slot) : slot];
    if (from.flags == NONE) return 0u;
    Sampler s = ofFirst ? gatherSampler(args.of, slot) : eyeSampler(args.of, slot, SAMPLES_GATHER);
    if (hasEndless && args.sends == SPLIT_BEYOND) return uint(sendRayBeyond(slot, from, s)) << QUEUE_SHADOW;
    if (args.sends == SPLIT_LIGHT) return uint(sendLightSample(slot, from, s)) << QUEUE_SHADOW;
    return uint(sendLightSample(slot, from, s)) << QUEUE_SHADOW | uint(sendGatherRay(slot, from, s)) << QUEUE_CONTINUE;
}

void main() {
    uint place = threadIndex();
    if (place >= args.count) return;
    uint slot = args.firstSlot + place;
    args.list.at[place] = slot;
    putFlags(args.flags, place, EYE_QUEUES, send(slot));
}
