/// A photon map: its photons, their cells, and how wide gathers are.
#pragma once
#include "render/camera_paths.h"
#include "render/guide.h"
#include "render/photon_grid.h"
#include "render/photon_tracing.h"
#include "render/radius.h"
#include "render/radius_field.h"
#include "shared_photons.h"
#include <optional>
#include <string_view>
#include <vector>

namespace vkpm {

/// The photons of a map once more, in cells for discs narrower than its own. It answers where most photons want such
/// discs.
struct NarrowMap {
    PhotonGrid grid;
    RadiusField field;
    float radius; // of the first pass, the widest
    PhotonMap map{};

    uint levels() const { return static_cast<uint>(-field.smallest); }
};

/// A photon map that is made anew for each pass.
class PhotonMapStage {
public:
    /// Emits `batch` photons at a time, each of `flux` W over their number. Radii are the settings', or measured.
    /// Throws InputError if the settings' radius is smaller than roundings of coordinates. The scene has to outlive the
    /// map.
    PhotonMapStage(Gpu& gpu, const UploadedScene& scene, const Extent& extent, const Settings& settings,
                   const Features& features, MapKind kind, float flux, uint batch);

    /// Emits by a guide from now on; radii have to be measured again.
    void setGuide(Guide learned);
    /// Emits as if the guide were not learned yet.
    void clearGuide();
    const std::optional<Guide>& guide() const { return learned; }
    bool isGuided() const { return learned && learned->nodes.size(); }

    /// Measures radii of the photons as they are emitted now, unless they are known. Photons that the eye does not see
    /// do not count, if it is known which.
    void measureRadii();

    /// Records the cells of a pass, whose photons are there, if they are not yet those that were recorded last.
    void recordCells(Recording& recording, uint pass);
    /// Completes them, once they were submitted.
    void finishCells();
    /// The map that was made last; that of narrow discs, the narrowest first.
    const PhotonMap& map() const { return built; }
    std::vector<PhotonMap> narrowMaps() const;
    /// The same before photons are there: widths of gathers alone.
    PhotonMap widths() const;
    std::vector<PhotonMap> narrowWidths() const;

    /// Radii of the first pass: the least one, that of most photons, the greatest.
    float smallestRadius() const;
    float medianRadius() const;
    float greatestRadius() const;
    /// Whether discs would be narrower still but for the rounding of coordinates.
    bool roundingBinds() const { return isRoundingBound; }

    const MapKind kind;
    PhotonTracing tracing;
    PhotonLedger ledger{}; // of all passes, kept by the renderer

private:
    void checkRadius(std::string_view name);
    void measureNarrow(const Extent& lit, uint stored, float perDisc, uint levels);
    std::vector<vec3> somePlaces(std::uint64_t stored) const;
    /// How often cells are split for the narrowest radii, but for those of narrow maps.
    uint levels() const { return field ? static_cast<uint>(-field->smallest) : 1; }

    Gpu& gpu;
    Settings settings;
    Extent extent;
    PhotonGrid grid;
    float flux;   // W per photon
    float radius; // of the first pass, the widest
    bool radiusIsAutomatic;
    bool radiusIsValid = false;         // whether radii are those of the photons as they are emitted now
    std::optional<RadiusField> field{}; // where the radius is less, if it is automatic
    std::vector<NarrowMap> narrow{};    // where it is less than the cells of one map can be, the narrowest last
    bool isRoundingBound = false;
    std::optional<Guide> learned{};
    PhotonMap built{};
    std::optional<uint> builtPass{}, recordedPass{};
};

} // namespace vkpm
