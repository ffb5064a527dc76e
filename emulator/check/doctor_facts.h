#pragma once
// What this machine has, as `hilcam doctor` wants to know it. Changes nothing; ports are tried and given
// back.

#include "emulator/check/doctor.h"

namespace hilcam {

MachineFacts look_at_machine(const BenchNeeds& needs);

}  // namespace hilcam
