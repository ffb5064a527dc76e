#pragma once
// Brings cached light up to where the sources are: at once where a frame needs it, and ahead of time, on a
// thread of its own, where it can be told what the next frames will need. What is cached for a target is the
// same either way.

#include <memory>
#include <vector>

#include "render/radiosity/kept_solver.h"
#include "render/radiosity/kept_target.h"
#include "render/vocabulary/ahead_thread.h"

namespace hilcam {

class KeptUpdates {
  public:
    // lights: by object, null where none is cached; with the terms in their order. All outlive this. Owner
    // thread.
    KeptUpdates(std::span<IrradianceCache* const> lights, const EmbreeScene& scene, const KeptTerms& terms);
    KeptUpdates(const KeptUpdates&) = delete;
    KeptUpdates& operator=(const KeptUpdates&) = delete;

    // The lights have what the target asks for when this returns. Loop; where the thread is at work it gives up
    // the term that it is at, and what is left is made here.
    void bring_to(const KeptTarget& target);
    // Asks the thread for what will be needed; does nothing while it is at work. Loop.
    void look_ahead(const KeptTarget& target);
    // Ends the thread (AheadThread). Owner thread.
    void stop_looking_ahead() { ahead_.stop(); }
    // Returns an object's share of the memory of what is made and not taken yet, and of the work.
    std::size_t bytes(std::size_t object) const;
    bool is_busy() const { return ahead_.is_busy(); }

  private:
    // The parts that have been made and not been taken: links by object, solutions by object and term; and what
    // of the target they were made for.
    struct Stage {
        KeptTarget target;
        std::vector<KeptLinks> links;
        std::vector<std::vector<KeptSolution>> solutions;
        std::vector<std::uint8_t> has_links;
        std::vector<std::vector<std::uint8_t>> has_solution;
    };

    std::vector<IrradianceCache*> lights_;
    KeptTerms terms_;
    KeptSolver solver_;
    KeptTarget shown_;
    std::vector<KeptLinks> links_;  // shown
    Stage stage_;
    KeptTarget wanted_;
    std::vector<std::size_t> order_;  // objects whose light is cached, by their groups
    std::vector<KeptSolver::Member> members_;
    AheadThread ahead_;  // the last: it ends first

    void prepare(const KeptTarget& target);
    void prepare_links(const KeptTarget& target);
    bool is_regrouped(const KeptTarget& target, std::size_t member) const;
    void prepare_group(const KeptTarget& target, std::size_t term, std::span<const std::size_t> group,
                       bool regrouped);
    void adopt();
};

}  // namespace hilcam
