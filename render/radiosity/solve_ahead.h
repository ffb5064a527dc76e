#pragma once
// Brings cached light up to where the sources are: at once where a frame needs it, and ahead of time, on a
// thread of its own, where it can be told what the next frames will need. What is cached for a key is the
// same either way.

#include <memory>
#include <vector>

#include "render/radiosity/radiosity_solver.h"
#include "render/radiosity/solve_key.h"
#include "render/vocabulary/ahead_thread.h"

namespace hilcam {

class SolveAhead {
  public:
    // lights: by object, null where none is cached; with the terms in their order. All outlive this. Owner
    // thread.
    SolveAhead(std::span<IrradianceCache* const> lights, const EmbreeScene& scene,
               const RadiosityTerms& terms);
    SolveAhead(const SolveAhead&) = delete;
    SolveAhead& operator=(const SolveAhead&) = delete;

    // The lights have what the key asks for when this returns. Loop; where the thread is at work it gives up
    // the term that it is at, and what is left is made here.
    void bring_to(const SolveKey& key);
    // Asks the thread for what will be needed; does nothing while it is at work. Loop.
    void look_ahead(const SolveKey& key);
    // Ends the thread (AheadThread). Owner thread.
    void stop_looking_ahead() { ahead_.stop(); }
    // Returns an object's share of the memory of what is made and not taken yet, and of the work.
    std::size_t bytes(std::size_t object) const;
    bool is_busy() const { return ahead_.is_busy(); }

  private:
    // The parts that have been made and not been taken: links by object, solutions by object and term; and what
    // of the key they were made for.
    struct Stage {
        SolveKey key;
        std::vector<InterObjectLinks> links;
        std::vector<std::vector<RadiositySolution>> solutions;
        std::vector<std::uint8_t> has_links;
        std::vector<std::vector<std::uint8_t>> has_solution;
    };

    std::vector<IrradianceCache*> lights_;
    RadiosityTerms terms_;
    RadiositySolver solver_;
    SolveKey shown_;
    std::vector<InterObjectLinks> links_;  // shown
    Stage stage_;
    SolveKey wanted_;
    std::vector<std::size_t> order_;  // objects whose light is cached, by their groups
    std::vector<RadiositySolver::Member> members_;
    AheadThread ahead_;  // the last: it ends first

    void prepare(const SolveKey& key);
    void prepare_links(const SolveKey& key);
    bool is_regrouped(const SolveKey& key, std::size_t member) const;
    void prepare_group(const SolveKey& key, std::size_t term, std::span<const std::size_t> group,
                       bool regrouped);
    void adopt();
};

}  // namespace hilcam
