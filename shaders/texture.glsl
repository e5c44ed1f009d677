// Textures: what they say at a place of a surface. Filtered in floats, by the same arithmetic on every device, and
// without smaller copies of images: pixels are means over passes, which see all texels.
#ifndef TEXTURE_GLSL
#define TEXTURE_GLSL
#include "common.glsl"
#include "lobes.glsl"
#include "shared_scene.h"

const uint SLOT_COLOR = 0u; // of MaterialTextures
const uint SLOT_METALLIC = 1u;
const uint SLOT_ROUGHNESS = 2u;
const uint SLOT_SPECULAR = 3u;
const uint SLOT_SPECULAR_COLOR = 4u;
const uint SLOT_TRANSMISSION = 5u;

// What a texel holds, linear, with alpha.
vec4 texelAt(DeviceScene scene, TexelImage image, uint x, uint y) {
    uint index = y * image.width + x;
    if (image.format == TEXELS_FLOAT) {
        uint i = image.first + 4u * index;
        return uintBitsToFloat(uvec4(uintPtr(scene.texels).at[i], uintPtr(scene.texels).at[i + 1u],
                                     uintPtr(scene.texels).at[i + 2u], uintPtr(scene.texels).at[i + 3u]));
    }
    uint word = uintPtr(scene.texels).at[image.first + index];
    uint table = image.format == TEXELS_SRGB ? 0u : TEXEL_TABLE;
    return vec4(floatPtr(scene.texels).at[table + (word & 255u)], floatPtr(scene.texels).at[table + (word >> 8 & 255u)],
                floatPtr(scene.texels).at[table + (word >> 16 & 255u)],
                floatPtr(scene.texels).at[TEXEL_TABLE + (word >> 24)]);
}

// A coordinate within the first period of its wrapping, so that texels may be counted by integers.
float folded(float x, uint wrap) {
    if (wrap == WRAP_CLAMP) return clamp(x, 0.0, 1.0);
    float period = wrap == WRAP_MIRROR ? 2.0 : 1.0;
    return x - period * floor(x / period);
}

// The texel of an index from -1 to size x period.
uint wrapped(int i, uint size, uint wrap) {
    if (wrap == WRAP_CLAMP) return uint(clamp(i, 0, int(size) - 1));
    if (wrap == WRAP_REPEAT) return uint(i + int(size)) % size;
    uint k = uint(i + 2 * int(size)) % (2u * size);
    return min(k, 2u * size - 1u - k);
}

// The value of a texture at the coordinates of a surface: bilinear between the middles of texels.
vec4 textureAt(DeviceScene scene, Texture t, vec2 coordinates) {
    TexelImage image = TexelImagePtr(scene.images).at[t.image];
    float x = folded(dot(t.u, vec3(coordinates, 1.0)), t.wrapU) * float(image.width);
    float y = folded(dot(t.v, vec3(coordinates, 1.0)), t.wrapV) * float(image.height);
    if (t.nearest != 0u)
        return texelAt(scene, image, wrapped(int(x), image.width, t.wrapU), wrapped(int(y), image.height, t.wrapV));
    int i = int(floor(x - 0.5)), j = int(floor(y - 0.5));
    float s = x - 0.5 - float(i), r = y - 0.5 - float(j);
    uint left = wrapped(i, image.width, t.wrapU), right = wrapped(i + 1, image.width, t.wrapU);
    vec4 low = vec4(0.0), high = vec4(0.0);
    [[dont_unroll]] for (int k = 0; k < 2; k++) {
        uint row = wrapped(j + k, image.height, t.wrapV);
        vec4 a = texelAt(scene, image, left, row), b = texelAt(scene, image, right, row);
        low = high;
        high = a + s * (b - a); // equal ones stay what they are
    }
    return low + r * (high - low);
}

// The same by the set of coordinates that the texture has.
vec4 textureAt(DeviceScene scene, Texture t, vec2 sets[2]) {
    return textureAt(scene, t, t.set == 0u ? sets[0] : sets[1]);
}

vec2 mixed(TexturePlaces c, vec2 weights) { return c.a + weights.x * (c.b - c.a) + weights.y * (c.c - c.a); }

// Of a point on a sphere, by its direction from the centre: the middle of the image lies towards +z, its top at +y.
vec2 sphereCoordinates(vec3 n) {
    return vec2(0.5 + atan(n.x, n.z) / (2.0 * PI), 0.5 + asin(clamp(n.y, -1.0, 1.0)) / PI);
}

// Both sets of coordinates at a point of a primitive; of triangles by the weights of b and c.
vec2[2] coordinatesAt(DeviceScene scene, uint primitive, vec2 weights, vec3 position) {
    if (primitive >= scene.triangleCount) {
        vec2 c = sphereCoordinates(normalize(position - PrimitivePtr(scene.primitives).at[primitive].a));
        return vec2[2](c, c);
    }
    vec2 first = vec2(0.0), second = vec2(0.0);
    TexturePlacesPtr all = TexturePlacesPtr(scene.coordinates);
    if (scene.coordinateSets > 0u) first = mixed(all.at[primitive], weights);
    if (scene.coordinateSets > 1u) second = mixed(all.at[scene.triangleCount + primitive], weights);
    return vec2[2](first, second);
}

// The weights x and y of a point d = x u + y v, or of one next to the plane of u and v, within 0 to 1.
vec2 weightsOf(vec3 u, vec3 v, vec3 d) {
    float scale = unitScale(u, v);
    u *= scale;
    v *= scale;
    d *= scale;
    vec3 n = cross(u, v);
    return clamp(vec2(dot(cross(d, v), n), dot(cross(u, d), n)) / max(dot(n, n), 1e-30), 0.0, 1.0);
}

vec2 weightsAt(DeviceScene scene, uint primitive, vec3 position) {
    Primitive p = PrimitivePtr(scene.primitives).at[primitive];
    return weightsOf(p.b - p.a, p.c - p.a, position - p.a);
}

// What a light with a texture emits at a point of it.
vec3 texturedRadiance(DeviceScene scene, Light light, vec3 position) {
    LightTexture place = LightTexturePtr(scene.lightTextures).at[light.texture - 1u];
    precise vec3 fromCorner = position - light.a; // or drivers know better, where they see how the point was made
    vec2 coordinates;
    if (light.kind == LIGHT_SPHERE) {
        coordinates = sphereCoordinates(normalize(fromCorner));
    } else {
        vec2 w = weightsOf(light.u, light.v, fromCorner);
        coordinates = place.a + w.x * place.u + w.y * place.v;
    }
    Texture t = TexturePtr(scene.textures).at[place.texture];
    return t.factor * textureAt(scene, t, coordinates).rgb;
}

// The width of a lobe, and what it leaves to a diffuse one, by its roughness.
void setRoughness(inout Material m, float roughness) {
    m.alpha = max(roughness * roughness, LEAST_ALPHA);
    if (m.rest == NONE) return;
    float x = roughness * float(ROUGHNESS_STEPS);
    uint i = min(uint(x), ROUGHNESS_STEPS - 1u);
    m.rest += i * restRows(m);
    m.restFraction = x - float(i);
}

// A material with what its textures from `first` on say at a point of a primitive. A loop in place of three calls: code
// of textures is long to compile.
Material texturedMaterial(DeviceScene scene, Material m, uint first, uint primitive, vec2 weights, vec3 position) {
    MaterialTextures slots = MaterialTexturesPtr(scene.materialTextures).at[m.textures - 1u];
    vec2 coordinates[2] = coordinatesAt(scene, primitive, weights, position);
    uint end = isStandard(m) ? SLOT_TRANSMISSION : SLOT_ROUGHNESS;
    [[dont_unroll]] for (uint i = first; i <= end; i++) {
        uint index = i == SLOT_COLOR            ? slots.color
                     : i == SLOT_METALLIC       ? slots.metallic
                     : i == SLOT_ROUGHNESS      ? slots.roughness
                     : i == SLOT_SPECULAR       ? slots.specular
                     : i == SLOT_SPECULAR_COLOR ? slots.specularColor
                                                : slots.transmission;
        if (index == NONE) continue;
        Texture t = TexturePtr(scene.textures).at[index];
        vec4 value = textureAt(scene, t, coordinates);
        float number = clamp(t.factor.x * value[t.channel], 0.0, 1.0);
        if (i == SLOT_COLOR) m.color = min(t.factor * value.rgb, 1.0);
        else if (i == SLOT_METALLIC) m.metallic = number;
        else if (i == SLOT_ROUGHNESS) setRoughness(m, number);
        else if (i == SLOT_SPECULAR) m.grazing = number;
        else if (i == SLOT_SPECULAR_COLOR) m.normalIncidence = t.factor * value.rgb;
        else m.transmission = number;
    }
    if (isStandard(m) && (slots.specular & slots.specularColor) != NONE)
        m.normalIncidence = m.grazing * min(m.normalIncidence, 1.0);
    if (slots.colors != 0u && first == SLOT_COLOR && primitive < scene.triangleCount) {
        VertexColors c = VertexColorsPtr(scene.colors).at[primitive];
        m.color *= c.a + weights.x * (c.b - c.a) + weights.y * (c.c - c.a);
    }
    return m;
}

#endif
