/// The page of a report: one file that needs no other.
#pragma once
#include "measure/report.h"

namespace vkpm {

/// HTML with the picture, maps of its error and of FLIP (with a reference), the curves and the last row. `facts` are
/// shown as a list.
std::string reportPage(const std::vector<ReportRow>& rows, const Image& image, std::span<const uint> picture,
                       const Image* reference, const std::vector<std::pair<std::string, std::string>>& facts);

} // namespace vkpm
