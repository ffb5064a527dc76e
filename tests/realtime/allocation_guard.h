#pragma once
// Counts every operator new of the program, on every thread, while it is armed. What libraries (Embree's commit of a scene,
// oneTBB's own pools) allocate is told apart by who calls.

#include <gtest/gtest.h>

namespace hilcam {

// Numbers of allocations.
struct Allocations {
    int own =
        0;  // of the program, but for threads whose work it is to make what the loop is given or gives away
    int terrain = 0;  // of the thread that makes the ground's meshes, which is one of those
};

// Once before the first arming: a first call of some functions allocates by itself.
void prepare_allocation_guard();
void arm_allocation_guard();
// Returns what was counted since it was armed; disarms it.
Allocations counted_allocations();

// Tests that arm it; a test that ends early leaves it disarmed.
class Allocation : public testing::Test {
  protected:
    static void SetUpTestSuite() { prepare_allocation_guard(); }
    void TearDown() override { counted_allocations(); }
};

}  // namespace hilcam
