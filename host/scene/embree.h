/// Embree 3 or 4, whichever is installed; they differ in the names of their headers and in what a query takes.
#pragma once
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace vkpm {

#if RTC_VERSION_MAJOR >= 4
inline void intersectOne(RTCScene scene, RTCRayHit& query) { rtcIntersect1(scene, &query); }
inline void occludedOne(RTCScene scene, RTCRay& query) { rtcOccluded1(scene, &query); }
#else
inline void intersectOne(RTCScene scene, RTCRayHit& query) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &query);
}
inline void occludedOne(RTCScene scene, RTCRay& query) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene, &context, &query);
}
#endif

} // namespace vkpm
