// The driver audit.
#ifndef SHARED_AUDIT_H
#define SHARED_AUDIT_H
#include "shared.h"

SHARED_BEGIN

const uint AUDIT_LOOP = 0u;
const uint AUDIT_DIVERGENT = 1u;
const uint AUDIT_SHARED = 2u;
const uint AUDIT_WIDE = 3u;
const uint AUDIT_FLOAT = 4u;

struct AuditArgs {
    PTR(uint) results;
    uint count;
    uint test; // AUDIT_...
    uint trips;
};

SHARED_END
#endif
