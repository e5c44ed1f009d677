/// The page of a report: one file that needs no other.
#pragma once
#include "measure/report.h"

namespace vkpm {

/// HTML with the picture, the map of its intervals, maps of its error and of FLIP (with a reference), the curves and a
/// table by layer. `facts` are shown as a list.
std::string reportPage(const std::vector<ReportRow>& rows, const ReportPicture& picture, const Image* reference,
                       const std::vector<std::pair<std::string, std::string>>& facts);

} // namespace vkpm
