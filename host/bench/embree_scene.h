/// A scene in Embree: the independent oracle of rays, and the yardstick of their speed.
#pragma once
#include "scene/embree.h"
#include "scene/scene.h"
#include "shared_paths.h"
#include "shared_scene.h"

namespace vkpm {

/// Embree's own hierarchy over the triangles and spheres of a scene; queries may come from any number of threads.
class EmbreeScene {
public:
    /// RTC_SCENE_FLAG_ROBUST makes triangles watertight, at some cost.
    explicit EmbreeScene(const Scene& source, RTCSceneFlags flags = RTC_SCENE_FLAG_NONE)
        : triangleCount(source.triangleCount), device(rtcNewDevice(nullptr)) {
        if (!device) throw std::runtime_error("rtcNewDevice: error " + std::to_string(rtcGetDeviceError(nullptr)));
        scene = rtcNewScene(device);
        rtcSetSceneFlags(scene, flags);
        rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
        if (triangleCount > 0) attachTriangles(source);
        if (source.primitives.size() > triangleCount) attachSpheres(source);
        rtcCommitScene(scene);
    }
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;
    ~EmbreeScene() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }

    /// The closest hit with t > tMin, in units of the direction's length; the weights of a sphere's hit mean nothing.
    Hit closest(vec3 origin, vec3 direction, float tMin = 0) const {
        RTCRayHit query{};
        query.ray = ray(origin, direction, std::numeric_limits<float>::infinity());
        query.ray.tnear = tMin;
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        intersectOne(scene, query);
        if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {query.ray.tfar, NONE, vec2{0}};
        const uint first = query.hit.geomID == SPHERES ? triangleCount : 0;
        return {query.ray.tfar, first + query.hit.primID, {query.hit.u, query.hit.v}};
    }

    /// Whether anything stands between two points.
    bool occluded(vec3 origin, vec3 target) const {
        RTCRay query = ray(origin, target - origin, 1);
        occludedOne(scene, query);
        return query.tfar < 0;
    }

private:
    static constexpr unsigned TRIANGLES = 0, SPHERES = 1; // Embree's geometry IDs

    static RTCRay ray(vec3 o, vec3 d, float tMax) { return {o.x, o.y, o.z, 0, d.x, d.y, d.z, 0, tMax, ~0u, 0, 0}; }

    void attach(RTCGeometry geometry, unsigned id) {
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene, geometry, id);
        rtcReleaseGeometry(geometry);
    }

    void attachTriangles(const Scene& source) {
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* points = static_cast<vec3*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                                  RTC_FORMAT_FLOAT3, sizeof(vec3), 3 * triangleCount));
        auto* corners = static_cast<uint*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                   3 * sizeof(uint), triangleCount));
        for (uint i = 0; i < triangleCount; i++) {
            const Primitive& triangle = source.primitives[i];
            points[3 * i] = triangle.a;
            points[3 * i + 1] = triangle.b;
            points[3 * i + 2] = triangle.c;
        }
        for (uint i = 0; i < 3 * triangleCount; i++) corners[i] = i;
        attach(geometry, TRIANGLES);
    }

    void attachSpheres(const Scene& source) {
        const std::size_t count = source.primitives.size() - triangleCount;
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
        auto* spheres = static_cast<vec4*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, sizeof(vec4), count));
        for (std::size_t i = 0; i < count; i++) {
            const Primitive& sphere = source.primitives[triangleCount + i];
            spheres[i] = vec4(sphere.a, sphere.b.x);
        }
        attach(geometry, SPHERES);
    }

    uint triangleCount;
    RTCDevice device;
    RTCScene scene = nullptr;
};

} // namespace vkpm
