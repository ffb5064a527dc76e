#pragma once
// Collects the facts about this machine that `hilcam doctor` needs. Changes nothing; ports are opened and
// closed again.

#include "emulator/check/doctor.h"

namespace hilcam {

MachineFacts look_at_machine(const BenchNeeds& needs);

}  // namespace hilcam
