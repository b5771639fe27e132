#pragma once

#include <string>
#include <vector>

#include "adamas/export.h"
#include "adamas/meshes.h"
#include "adamas/progress.h"
#include "adamas/resample.h"
#include "adamas/text.h"

namespace adamas ADAMAS_API {

// This header writes figures of reports as the command line and the reports of experiments show them.

/// Returns a volume with six digits.
std::string volume_text(double volume);
/// Returns the relative change of a volume in percent, "-0.020%", and "-" where the volume before is 0.
std::string difference_text(double before, double after);
/// Returns the differences in topology between a body and its former state: "in 2 pieces instead of 1, and
/// its boundary has the Euler characteristic 4 instead of 2".
std::string topology_text(const BodyTopology& before, const BodyTopology& after);

/// Returns one line that says which error was not reached, and why.
std::string unreached_text(const UnreachedError& error);
/// Returns such lines for all unreached errors of a mesh, of volumes too: for all bodies, or for the worst
/// one, with the number of the others.
std::vector<std::string> unreached_lines(const ResampleReport& report, bool all_bodies = true);

/// Notes the errors that a mesh does not reach (NoteKind::kIncomplete), and the bodies and materials that it
/// shows changed or not at all.
void note_resampled(const ResampleReport& report, Progress& progress);

}  // namespace adamas
