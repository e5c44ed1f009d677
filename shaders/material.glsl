// How materials scatter light, whatever their kind.
#ifndef MATERIAL_GLSL
#define MATERIAL_GLSL
#include "bsdf_diffuse.glsl"
#include "bsdf_glass.glsl"
#include "bsdf_mirror.glsl"
#include "common.glsl"
#include "scattering.glsl"
#include "shared_kinds.h"
#include "shared_paths.h"
#include "shared_scene.h"
#include "surface.glsl"

// Whether a scene has materials with a diffuse lobe, and with others.
const bool hasDiffuse = (materialKinds & DIFFUSE_KINDS) != 0u;
const bool hasSpecular = (materialKinds & SPECULAR_KINDS) != 0u;

// Whether a material has a diffuse lobe.
bool isDiffuse(Material m) { return hasDiffuse && (!hasSpecular || m.kind == MATERIAL_DIFFUSE); }

// Whether a material is of a kind that has other lobes, asked in the order of the list: the last one that a scene has
// needs no look.
bool isNextKind(Material m, uint kind) {
    const uint kinds = materialKinds & SPECULAR_KINDS;
    return (kinds & 1u << kind) != 0u && (kinds >> kind == 1u || m.kind == kind);
}

// One event of a ray of direction d about the normal n, which is on its side.
#define X(id, NAME, name, lobes, words)                                                                                \
    if (isNextKind(m, id)) return sample##name(m, d, n, leaving, u);
Scattering scatterAbout(Material m, vec3 d, vec3 n, bool leaving, float u) {
    MATERIALS(X)
    return sampleDiffuse(m, d, n, leaving, u);
}
#undef X

// Specular scattering of a ray of direction d. About the shading normal, unless that would put the ray on the
// side of the geometric normal where the other kind of event belongs; then about the geometric one.
Scattering scatterSpecular(Material m, Surface s, vec3 d, float u) {
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

// What a photon's flux is multiplied by since shading normals are not the geometric ones (Veach 1997, eq. 5.19);
// wi against its direction of arrival, wo along that of departure, for a specular event about n.
float specularCorrection(vec3 wi, vec3 wo, vec3 n, vec3 geometric) {
    if (!hasSmoothNormals || n == geometric || n == -geometric) return 1.0;
    return abs(dot(wi, n) * dot(wo, geometric)) / max(abs(dot(wi, geometric) * dot(wo, n)), 1e-6);
}

// Specular vertices of a path since its last diffuse one, up to 63, and its flags after one more.
uint specularRun(uint flags) { return (flags & PATH_SPECULARS) / PATH_SPECULAR; }

uint afterSpecular(uint flags) { return (flags & PATH_SPECULARS) == PATH_SPECULARS ? flags : flags + PATH_SPECULAR; }

// Probability with which a path goes on at a specular surface after a run of others. Light within glass near the
// critical angle may be reflected for ever without loss: from the 32nd on a tenth ends at each. Only a run counts: in a
// bright room, where paths have hundreds of vertices, the weights that make up for such ends would grow without bound.
float specularSurvival(vec3 weight, uint run) { return min(maxComponent(weight), run < 32u ? 1.0 : 0.9); }

#endif
