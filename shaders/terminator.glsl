// Smooth meshes stand for curved surfaces: light may come from any side of the shading normal, below the plane of the
// triangle too, which else cuts the light of coarse meshes off in stairs. Where the surface bulges towards that side,
// such light has come through the mesh: by one triangle of a smooth diffuse mesh, from behind, and no more. Where it is
// hollow, the light is that of directions mirrored at the triangle, so that none is lost. Photons go the same ways
// backwards, so that the adjoint holds (Veach 1997, section 5.3). `bulge` is 0 for flat shading, positive where the
// surface bulges on the side of `normal`, negative where it is hollow.
#ifndef TERMINATOR_GLSL
#define TERMINATOR_GLSL
#include "common.glsl"

// The cosine with which light from direction w counts.
float cosineOfArrival(vec3 w, vec3 normal, vec3 shading, float bulge) {
    float cosine = max(0.0, dot(w, shading));
    if (dot(w, normal) > 0.0) {
        if (!hasSmoothDiffuse || bulge >= 0.0) return cosine;
        return cosine + max(0.0, dot(reflect(w, normal), shading));
    }
    return hasSmoothDiffuse && bulge > 0.0 ? cosine : 0.0;
}

// Whether a ray in a direction that leaves on the side of the shading normal has to go through the mesh.
bool goesThrough(vec3 w, vec3 normal, float bulge) { return hasSmoothDiffuse && bulge > 0.0 && dot(w, normal) <= 0.0; }

// Whether there is a ray for a direction that was chosen about the shading normal, which is made the ray's.
bool departs(inout vec3 w, vec3 normal, float bulge) {
    if (dot(w, normal) > 0.0) return true;
    if (!hasSmoothDiffuse || bulge == 0.0) return false;
    if (bulge < 0.0) w = reflect(w, normal);
    return true;
}

#endif
