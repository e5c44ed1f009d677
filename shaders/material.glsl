// How materials scatter light, whatever their kind.
#ifndef MATERIAL_GLSL
#define MATERIAL_GLSL
#include "bsdf_diffuse.glsl"
#include "bsdf_glass.glsl"
#include "bsdf_metal.glsl"
#include "bsdf_mirror.glsl"
#include "bsdf_plastic.glsl"
#include "bsdf_rough_glass.glsl"
#include "bsdf_standard.glsl"
#include "bsdf_thin_glass.glsl"
#include "common.glsl"
#include "light_kinds.glsl"
#include "lobes.glsl"
#include "normal_map.glsl"
#include "random.glsl"
#include "scattering.glsl"
#include "shared_kinds.h"
#include "shared_paths.h"
#include "shared_scene.h"
#include "surface.glsl"
#include "terminator.glsl"
#include "texture.glsl"

bool isGlossy(Material m) { return hasGlossy && (GLOSSY_KINDS >> m.kind & 1u) != 0u; }

// Whether a material has a diffuse lobe, and whether it has another.
bool isDiffuse(Material m) {
    if (!hasDiffuse || !hasSpecular) return hasDiffuse;
    return m.kind == MATERIAL_DIFFUSE || (hasLayered && (LAYERED_KINDS >> m.kind & 1u) != 0u && m.rest != NONE);
}

bool isSpecular(Material m) { return hasSpecular && (hasLayered ? m.kind != MATERIAL_DIFFUSE : !isDiffuse(m)); }

// Whether a material is of a kind, of some of which it is one, asked in the order of the list: the last one that a
// scene has needs no look.
bool isNextKind(Material m, uint kind, uint of) {
    uint kinds = materialKinds & of;
    return (kinds & 1u << kind) != 0u && (kinds >> kind == 1u || m.kind == kind);
}

// One event of a ray of direction d about the normal n, which is on its side, in one direction, by the choice u.
#define X(id, NAME, name, lobes, words)                                                                                \
    if (isNextKind(m, id, DELTA_KINDS)) return sample##name(m, d, n, leaving, u);
Scattering scatterAbout(Material m, vec3 d, vec3 n, bool leaving, float u) {
    DELTA_MATERIALS(X)
    return sampleDiffuse(m, d, n, leaving, u);
}
#undef X

// The same by a glossy lobe: the choice by u.x, a direction by the others.
#define X(id, NAME, name, lobes, words)                                                                                \
    if (isNextKind(m, id, GLOSSY_KINDS)) return sample##name(m, d, n, leaving, u);
Scattering sampleGlossy(Material m, vec3 d, vec3 n, bool leaving, vec3 u) {
    GLOSSY_MATERIALS(X)
    return sampleDiffuse(m, d, n, leaving, u.x);
}
#undef X

// What a glossy lobe sends from wi to wo, times the cosine of wi; n is the normal on their side.
#define X(id, NAME, name, lobes, words)                                                                                \
    if (isNextKind(m, id, GLOSSY_KINDS)) return evaluate##name(m, leaving, n, wo, wi);
vec3 evaluateGlossy(Material m, bool leaving, vec3 n, vec3 wo, vec3 wi) {
    GLOSSY_MATERIALS(X)
    return vec3(0.0);
}
#undef X

// The density over solid angle with which a glossy lobe sends wo to wi.
#define X(id, NAME, name, lobes, words)                                                                                \
    if (isNextKind(m, id, GLOSSY_KINDS)) return pdf##name(m, leaving, n, wo, wi);
float pdfGlossy(Material m, bool leaving, vec3 n, vec3 wo, vec3 wi) {
    GLOSSY_MATERIALS(X)
    return 0.0;
}
#undef X

// What a glossy lobe reflects of the light from a direction, or about as much.
#define X(id, NAME, name, lobes, words)                                                                                \
    if (isNextKind(m, id, GLOSSY_KINDS)) return albedo##name(m, cosine, rest);
vec3 glossyAlbedo(Material m, float cosine, float rest) {
    GLOSSY_MATERIALS(X)
    return vec3(1.0);
}
#undef X

// The colour of the diffuse lobe of a layered material.
#define X(id, NAME, name, lobes, words)                                                                                \
    if (isNextKind(m, id, GLOSSY_KINDS)) return base##name(m, rest);
vec3 diffuseBase(Material m, float rest) {
    GLOSSY_MATERIALS(X)
    return m.color;
}
#undef X

float restOfRow(DeviceScene scene, uint row, float cosine) {
    float x = sqrt(clamp(cosine, 0.0, 1.0)) * float(REST_STEPS);
    uint i = min(uint(x), REST_STEPS - 1u), first = row * REST_ROW;
    return mix(floatPtr(scene.rests).at[first + i], floatPtr(scene.rests).at[first + i + 1u], x - float(i));
}

float meanRestOfRow(DeviceScene scene, uint row) { return floatPtr(scene.rests).at[row * REST_ROW + REST_MEAN]; }

// Where roughness is a texture, between the rows of two roughnesses.
float restOf(DeviceScene scene, Material m, uint row, float cosine) {
    float rest = restOfRow(scene, row, cosine);
    return hasTextures && m.restFraction > 0.0 ? mix(rest, restOfRow(scene, row + restRows(m), cosine), m.restFraction)
                                               : rest;
}

float meanRestOf(DeviceScene scene, Material m, uint row) {
    float rest = meanRestOfRow(scene, row);
    return hasTextures && m.restFraction > 0.0 ? mix(rest, meanRestOfRow(scene, row + restRows(m)), m.restFraction)
                                               : rest;
}

// The part of light at a cosine that the glossy lobe leaves.
float restAt(DeviceScene scene, Material m, float cosine) {
    if (m.rest == NONE) return 0.0;
    float rest = restOf(scene, m, m.rest, cosine);
    return isStandard(m) ? restStandard(m, rest, restOf(scene, m, m.rest + 1u, cosine)) : rest;
}

float meanRest(DeviceScene scene, Material m) {
    float rest = meanRestOf(scene, m, m.rest);
    return isStandard(m) ? restStandard(m, rest, meanRestOf(scene, m, m.rest + 1u)) : rest;
}

// That of perfect facets where there is metal.
float meanRestOfBase(DeviceScene scene, Material m) {
    return meanRestOf(scene, m, isStandard(m) ? m.rest + 1u : m.rest);
}

// The diffuse lobe is separable, so that photon maps need no directions: base x rest(out) x rest(in) / (pi mean rest).
// This is the factor of the direction in which the lobe is seen, with the base; it is also the lobe's albedo there.
vec3 diffuseAlbedo(DeviceScene scene, Material m, float cosine) {
    if (!hasLayered || m.kind == MATERIAL_DIFFUSE) return m.color;
    return diffuseBase(m, meanRestOfBase(scene, m)) * restAt(scene, m, cosine);
}

// And this of the direction from which the light comes; its mean by the cosine law is 1.
float diffuseArrival(DeviceScene scene, Material m, float cosine) {
    if (!hasLayered || m.kind == MATERIAL_DIFFUSE) return 1.0;
    return restAt(scene, m, cosine) / meanRest(scene, m);
}

// Surfaces that transmit a part are glass with the probability `transmission` of their dielectric, else a standard
// material with all of their metal: a mixture of both, chosen by a hash of the ray, as in opacity.glsl, and by the same
// rule for photons and rays from the eye.
bool isMixed(Material m) { return hasMixed && m.base != 0u; }

// Turns the material that stands beside glass into what is there where there is no glass; `transmission` becomes the
// probability of glass.
void takeBase(inout Material m) {
    m.transmission *= 1.0 - m.metallic;
    m.metallic = min(1.0, m.metallic / max(1.0 - m.transmission, 1e-6));
}

// The material of a surface where a path hit it, with what its textures say there.
Material materialAt(DeviceScene scene, Path path, Surface s, vec2 weights) {
    Material glass = MaterialPtr(scene.materials).at[s.material], m = glass;
    if (isMixed(glass)) m = MaterialPtr(scene.materials).at[glass.base - 1u];
    if (hasTextures && m.textures != 0u) m = texturedMaterial(scene, m, SLOT_COLOR, s.primitive, weights, s.position);
    if (!isMixed(glass)) return m;
    takeBase(m);
    if (choiceOfRay(path.origin, path.direction, ~s.primitive) >= m.transmission) return m;
    glass.color = m.color;
    glass.alpha = m.alpha;
    return glass;
}

// The material of a primitive at a place next to it, without glass, and of its textures those from a slot on.
Material materialNear(DeviceScene scene, uint primitive, vec3 position, uint first) {
    Material m = MaterialPtr(scene.materials).at[PrimitivePtr(scene.primitives).at[primitive].material];
    bool mixed = isMixed(m);
    if (mixed) m = MaterialPtr(scene.materials).at[m.base - 1u];
    if (hasTextures && m.textures != 0u)
        m = texturedMaterial(scene, m, first, primitive, weightsAt(scene, primitive, position), position);
    if (mixed) takeBase(m);
    return m;
}

// The factor of arrival there, which does not depend on the colour.
float diffuseArrivalAt(DeviceScene scene, uint primitive, vec3 position, float cosine) {
    return hasLayered ? diffuseArrival(scene, materialNear(scene, primitive, position, SLOT_METALLIC), cosine) : 1.0;
}

// The cosine with which light from direction w counts, see terminator.glsl, times the factor of arrival.
float weightOfArrival(DeviceScene scene, Material m, vec3 w, vec3 normal, vec3 shading, float bulge) {
    float cosine = dot(w, shading);
    if (bulge >= 0.0 || !hasNormalMaps)
        return cosineOfArrival(w, normal, shading, bulge) * diffuseArrival(scene, m, cosine);
    float mirrored = dot(reflect(w, normal), shading);
    float weight = cosine > 0.0 ? cosine * diffuseArrival(scene, m, cosine) : 0.0;
    if (mirrored > 0.0) weight += mirrored * diffuseArrival(scene, m, mirrored);
    return dot(w, normal) > 0.0 ? weight : 0.0;
}

// The normal about which light of direction d is scattered, on its side: the shading normal where d is on its side too.
vec3 scatteringNormal(Surface s, vec3 d) {
    bool leaving = dot(d, s.normal) > 0.0;
    vec3 shading = leaving ? -s.shading : s.shading;
    if (hasSmoothNormals && dot(d, shading) < 0.0) return shading;
    return leaving ? -s.normal : s.normal;
}

// What a glossy lobe sends from w towards -d, times the cosine of w, and the density with which it sends -d to w.
vec3 evaluateGlossyAt(Material m, Surface s, vec3 d, vec3 w, out float pdf) {
    bool leaving = dot(d, s.normal) > 0.0;
    vec3 n = isMapped(s) ? (leaving ? -s.shading : s.shading) : scatteringNormal(s, d);
    pdf = 0.0;
    if (!(dot(w, n) > 0.0 && dot(d, n) < 0.0)) return vec3(0.0);
    float kept = isMapped(s) ? mappedAcceptance(s, d, w) : 1.0;
    pdf = kept * pdfGlossy(m, leaving, n, -d, w);
    return kept * evaluateGlossy(m, leaving, n, -d, w);
}

bool isRoughGlass(Material m) { return hasRoughGlass && m.kind == MATERIAL_ROUGH_GLASS; }

// The same where w is beyond the interface, but for mapped normals.
vec3 evaluateBeyond(Material m, Surface s, vec3 d, vec3 w, out float pdf) {
    pdf = 0.0;
    if (!isRoughGlass(m) || isMapped(s)) return vec3(0.0);
    return refractRoughGlass(m, dot(d, s.normal) > 0.0, scatteringNormal(s, d), -d, w, pdf);
}

// Probability with which a path at a surface with both lobes takes the glossy one: by what they reflect, and at least a
// tenth of the paths for each.
float glossyProbability(DeviceScene scene, Material m, float cosine) {
    float glossy = maxComponent(glossyAlbedo(m, cosine, restAt(scene, m, cosine)));
    float diffuse = maxComponent(diffuseAlbedo(scene, m, cosine));
    return clamp(glossy / max(glossy + diffuse, 1e-30), 0.1, 0.9);
}

// Scattering of a ray of direction d by a glossy lobe; what comes out on the other side of the geometric normal than of
// the shading normal is lost.
Scattering scatterGlossy(Material m, Surface s, vec3 d, vec3 u) {
    bool leaving = dot(d, s.normal) > 0.0;
    vec3 n = scatteringNormal(s, d);
    Scattering event = sampleGlossy(m, d, n, leaving, u);
    if (hasSmoothNormals && dot(event.direction, n) > 0.0 != dot(event.direction, leaving ? -s.normal : s.normal) > 0.0)
        event.weight = vec3(0.0);
    return event;
}

// Scattering about a mapped normal, by any lobe but the diffuse one; see normal_map.glsl. The choice `accepted` is a
// number in [0, 1).
Scattering scatterMapped(Material m, Surface s, vec3 d, vec3 u, float accepted) {
    bool leaving = dot(d, s.normal) > 0.0;
    vec3 geometric = leaving ? -s.normal : s.normal, n = leaving ? -s.shading : s.shading;
    bool behind = !(dot(d, n) < 0.0);
    if (behind) n = geometric;
    Scattering event;
    if (hasGlossy && isGlossy(m)) event = sampleGlossy(m, d, n, leaving, u);
    else event = scatterAbout(m, d, n, leaving, u.x);
    bool isOnItsSide = dot(event.direction, n) > 0.0 == dot(event.direction, geometric) > 0.0;
    float kept = behind || !isOnItsSide ? 0.0 : mappedAcceptance(s, d, event.direction);
    if (accepted < kept)
        event.pdf = dot(event.direction, n) > 0.0 ? event.pdf * kept : 0.0; // no light sample goes beyond
    else event = Scattering(-d, event.weight, n, 1.0, 0.0);
    return event;
}

// Scattering of a ray of direction d in one direction. About the shading normal, unless that would put the ray on the
// side of the geometric normal where the other kind of event belongs; then about the geometric one.
Scattering scatterDelta(Material m, Surface s, vec3 d, float u) {
    bool leaving = dot(d, s.normal) > 0.0;
    vec3 geometric = leaving ? -s.normal : s.normal;
    if (!hasSmoothNormals) return scatterAbout(m, d, geometric, leaving, u);
    vec3 shading = leaving ? -s.shading : s.shading;
    if (dot(d, shading) < 0.0) {
        Scattering result = scatterAbout(m, d, shading, leaving, u);
        bool reflected = dot(result.direction, shading) > 0.0;
        if (reflected == (dot(result.direction, geometric) > 0.0)) return result;
    }
    return scatterAbout(m, d, geometric, leaving, u);
}

// Whether light goes straight through a surface of glass, see atInterface in media.glsl.
bool isPassage(Material m) { return hasMedia && m.medium == NONE; }

// Whether the label of what is not diffuse of a material is W.
bool isWide(Material m) { return hasWide && m.wide != 0u; }

// Whether photons bring the caustics that it shows.
bool showsPhotons(Material m) { return hasWide && m.wide == WIDE_BY_PHOTONS; }

// Scattering by any lobe but the diffuse one; `accepted` is a choice of mapped normals. (The constants beside the
// questions are what plain kernels are cut by.)
Scattering scatterSpecular(Material m, Surface s, vec3 d, vec3 u, float accepted) {
    if (hasMedia && isPassage(m))
        return Scattering(d, m.color, dot(d, s.normal) > 0.0 ? -s.normal : s.normal, 1.0, 0.0);
    if (isMapped(s)) return scatterMapped(m, s, d, u, accepted);
    if (hasGlossy && isGlossy(m)) return scatterGlossy(m, s, d, u);
    return scatterDelta(m, s, d, u.x);
}

// What a photon's flux is multiplied by since shading normals are not the geometric ones (Veach 1997, eq. 5.19);
// wi against its direction of arrival, wo along that of departure, for a specular event about n. Mapped normals need
// none.
float specularCorrection(vec3 wi, vec3 wo, vec3 n, vec3 geometric) {
    if (!hasSmoothNormals || n == geometric || n == -geometric) return 1.0;
    return abs(dot(wi, n) * dot(wo, geometric)) / max(abs(dot(wi, geometric) * dot(wo, n)), 1e-6);
}

// Specular vertices of a path since its last diffuse one, up to 63, and its flags after one more.
uint specularRun(uint flags) { return (flags & PATH_SPECULARS) / PATH_SPECULAR; }

// Whether paths know the density of their last event.
const bool hasPdf = hasGlossy || hasEndless;

// Whether there was a specular event, or one by a narrow lobe, since the last diffuse or wide vertex.
bool wasNarrow(uint flags) { return (flags & (hasWide ? PATH_NARROW : PATH_SPECULARS)) != 0u; }

// Whether the last event that was not such a one was wide.
bool wasWide(uint flags) { return hasWide && (flags & PATH_WIDE) != 0u; }

// Diffuse and wide vertices of a path from the eye.
uint diffuseCount(uint flags) {
    return hasPdf ? (flags & ~PATH_PDF_MASK) >> PATH_DIFFUSE_SHIFT : flags >> PATH_DIFFUSE_SHIFT;
}

// A density in the ten bits that flags have for it: an exponent and two digits. Both samplers of a light are weighted
// by this same number, so that its rounding moves no mean; 0 stands for an event of one direction alone.
uint packPdf(float pdf) { return pdf > 0.0 ? max(floatBitsToUint(pdf) >> 21, 1u) : 0u; }

float unpackPdf(uint bits) { return uintBitsToFloat(bits << 21); }

uint withPdf(uint flags, float pdf) {
    return hasPdf ? (flags & ~PATH_PDF_MASK) | packPdf(pdf) << PATH_PDF_SHIFT : flags;
}

float pdfOf(uint flags) { return hasPdf ? unpackPdf(flags >> PATH_PDF_SHIFT) : 0.0; }

uint afterSpecular(uint flags) { return (flags & PATH_SPECULARS) == PATH_SPECULARS ? flags : flags + PATH_SPECULAR; }

// The flags of a path from the eye after a diffuse vertex, or a wide one, but for those of this event.
uint afterDiffuse(uint flags) {
    return (flags & PATH_EYE_SPECULAR) | min(diffuseCount(flags) + 1u, MAX_DIFFUSE) << PATH_DIFFUSE_SHIFT;
}

// The same after any lobe but the diffuse one.
uint afterLobe(uint flags, bool wide) {
    if (wide) return afterDiffuse(flags) | afterSpecular(flags & PATH_SPECULARS) | PATH_WIDE;
    if (hasWide && (flags & PATH_ASKED) != 0u) flags &= ~(PATH_WIDE | PATH_ASKED); // as after a diffuse vertex
    flags = afterSpecular(flags) | (diffuseCount(flags) == 0u ? PATH_EYE_SPECULAR : 0u);
    return hasWide ? flags | PATH_NARROW : flags;
}

// Probability with which a path goes on at a specular surface after a run of others. Light within glass near the
// critical angle may be reflected for ever without loss: from the 32nd on a twentieth ends at each. Were it more,
// photons and lamps that the eye sees would grow heavy faster than they come out, and be specks of twenty of their
// like; of gather rays, which see neither, a tenth ends. Only a run counts: in a bright room, where paths have hundreds
// of vertices, the weights that make up for such ends would grow without bound.
float runSurvival(uint run, bool gathers) { return run < 32u ? 1.0 : gathers ? 0.9 : 0.95; }

float specularSurvival(vec3 weight, uint run, bool gathers) {
    return min(maxComponent(weight), runSurvival(run, gathers));
}

#endif
