#pragma once
// The facts about this machine that `hilcam doctor` wants to know. Changes nothing; ports are tried and given
// back.

#include "emulator/check/doctor.h"

namespace hilcam {

MachineFacts look_at_machine(const BenchNeeds& needs);

}  // namespace hilcam
