// Connects photons to the camera: the pixel that sees each one, and what it adds to the mean radiance of that pixel
// (light tracing, Arvo 1986; the camera's weight as in Dutré, Lafortune & Willems 1993).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "camera.glsl"
#include "common.glsl"
#include "directions.glsl"
#include "feature_checks.glsl"
#include "lens.glsl"
#include "material.glsl"
#include "media.glsl"
#include "offset.glsl"
#include "random.glsl"
#include "shared_paths.h"
#include "shared_photons.h"
#include "shared_scene.h"
#include "shared_splat.h"
#include "surface.glsl"
#include "traverse.glsl"

ARGS(SplatArgs)

uint noPixel() { return args.size.x * args.size.y; }

// The pixel that a direction goes through, if it does.
uint pixelOf(Camera camera, vec3 direction) {
    if (!(dot(direction, camera.forward) > 0.0)) return noPixel();
    vec2 film = filmPosition(camera, direction);
    if (!(min(film.x, film.y) >= 0.0 && max(film.x, film.y) < 1.0)) return noPixel();
    uvec2 pixel = min(uvec2(film * vec2(args.size)), args.size - 1u);
    return pixel.y * args.size.x + pixel.x;
}

// Whether the photon is where a ray from the eye ends. The ray meets the surface's plane once, so a photon in this
// plane is there; and it has to have arrived on the side that the ray comes from, unless light comes through.
bool isAt(Photon photon, Surface surface, Material material, vec3 direction) {
    vec3 normal = dot(direction, surface.normal) > 0.0 ? -surface.normal : surface.normal;
    float apart = abs(dot(surface.position - photon.position, normal));
    if (apart > roundingAlong(surface.magnitude, normal)) return false;
    return (hasWideGlass && isRoughGlass(material)) || dot(unpackUnit(photon.normal), normal) > 0.0;
}

// Whether the camera sees the photon; `radiance` is what the photon adds to its pixel's mean. Between film and surface
// go the cosine of the geometric normal and the square of the distance; what shading normals change is in the photon's
// color (Veach 1997, eq. 5.19).
bool sees(DeviceScene scene, vec3 eye, Photon photon, vec3 toPhoton, out vec3 radiance) {
    radiance = vec3(0.0);
    vec3 direction = normalize(toPhoton);
    Hit hit = closest(scene, eye, direction, NONE);
    if (hit.primitive == NONE) return false;
    Path path = Path(eye, direction, vec3(1.0), 0.0, NONE, 0u, 0u);
    Surface surface = surfaceAt(scene, path, hit);
    Material material = materialAt(scene, path, surface, hit.weights);
    requireSurface(scene, hit.primitive, material);
    mapNormal(scene, surface, material, hit.weights);
    bool wide = showsPhotons(material);
    if (!(wide || isDiffuse(material)) || !isAt(photon, surface, material, direction)) return false;

    float cosine = abs(dot(direction, surface.normal));
    vec3 scattered = vec3(0.0); // pi times what is scattered of the light
    if (isDiffuse(material))
        scattered = diffuseAlbedo(scene, material, -dot(direction, scatteringNormal(surface, direction)));
    if (wide) {
        bool behind = dot(direction, surface.normal) > 0.0;
        vec3 wi = unpackUnit(photon.normal), normal = behind ? -surface.normal : surface.normal;
        if (isDiffuse(material))
            scattered *= weightOfArrival(scene, material, wi, normal, behind ? -surface.shading : surface.shading,
                                         bulgeOn(surface, behind));
        float pdf;
        if (hasWideGlass && dot(wi, normal) < 0.0)
            scattered += PI * evaluateBeyond(material, surface, direction, wi, pdf);
        else scattered += PI * evaluateGlossyAt(material, surface, direction, wi, pdf);
    }
    float solidAngle = pixelSolidAngle(scene.camera, args.size, dot(direction, scene.camera.forward));
    radiance = photon.color * scattered * (args.photonFlux / PI * cosine / (dot(toPhoton, toPhoton) * solidAngle));
    if (hasMedia) radiance *= transmittance(scene, scene.cameraMedia, length(toPhoton));
    return true;
}

void main() {
    uint i = threadIndex();
    uint pixel = noPixel();
    bool onFilm = false;
    if (i < args.count) {
        DeviceScene scene = args.scene.at[0];
        Photon photon = args.photons.at[i];
        vec3 eye = scene.camera.origin, offset = vec3(0.0);
        bool lens = hasLens && scene.camera.aperture > 0.0;
        if (lens) {
            Sampler s = photonSampler(i, args.pass, args.seed, LENS_DIMENSION);
            offset = lensPoint(scene.camera, sample2(s, 0u));
            eye += offset;
        }
        vec3 toPhoton = photon.position - eye;
        bool before = dot(toPhoton, scene.camera.forward) > 0.0;
        if (!lens) pixel = pixelOf(scene.camera, toPhoton);
        else if (before) pixel = pixelOf(scene.camera, throughLens(scene.camera, offset, toPhoton));
        onFilm = pixel != noPixel();
        vec3 radiance = vec3(0.0);
        if (onFilm && !sees(scene, eye, photon, toPhoton, radiance)) pixel = noPixel();
        args.splats.at[i].radiance = radiance;
        args.pixels.at[i] = pixel;
        args.order.at[i] = i;
    }
    uint rays = subgroupAdd(uint(onFilm));
    if (subgroupElect() && rays > 0u) atomicAdd(args.rays.at[0], rays);
}
