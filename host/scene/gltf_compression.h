/// Meshes of glTF that are compressed: by Draco (KHR_draco_mesh_compression), by meshoptimizer
/// (EXT_meshopt_compression).
#pragma once
#include "scene/gltf_file.h"

namespace vkpm {

/// The extension of a buffer view whose bytes meshoptimizer packed, if it has it.
std::optional<Reader> meshoptOf(Reader& view);

/// The bytes of a buffer view, of those that its extension says. Throws InputError for what is damaged.
std::string unpackMeshopt(Reader extension, std::string_view packed);

/// Gives the file the elements of the accessors of a primitive that Draco packed; of others, nothing. Throws InputError
/// for what is damaged, or has other elements than the accessors say.
void unpackDraco(GltfFile& file, Reader primitive);

} // namespace vkpm
