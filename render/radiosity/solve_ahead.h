#pragma once
// Updates cached light to the sources' positions: at once if a frame needs it, or ahead of time on a thread
// of its own if the next frames can be predicted. The result for a key is the same either way.

#include <memory>
#include <vector>

#include "render/radiosity/radiosity_solver.h"
#include "render/radiosity/solve_key.h"
#include "render/vocabulary/ahead_thread.h"

namespace hilcam {

class SolveAhead {
  public:
    // lights: by object, null if the object caches no light; with their terms in order. All must outlive
    // this. Owner thread.
    SolveAhead(std::span<IrradianceCache* const> lights, const EmbreeScene& scene,
               const RadiosityTerms& terms);
    SolveAhead(const SolveAhead&) = delete;
    SolveAhead& operator=(const SolveAhead&) = delete;

    // Updates the lights to a key before it returns. If the thread is at work, it abandons its present term,
    // and the rest is computed here. Loop.
    void bring_to(const SolveKey& key);
    // Asks the thread for a key that will be needed; does nothing while the thread is at work. Loop.
    void look_ahead(const SolveKey& key);
    // Ends the thread (AheadThread). Owner thread.
    void stop_looking_ahead() { ahead_.stop(); }
    // Returns an object's share of the memory for finished but unused solutions, and for the solver.
    std::size_t bytes(std::size_t object) const;
    bool is_busy() const { return ahead_.is_busy(); }

  private:
    // Parts that are finished but not in use: links by object, solutions by object and term, and the key that
    // they belong to.
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
    std::vector<InterObjectLinks> links_;  // in use
    Stage stage_;
    SolveKey wanted_;
    std::vector<std::size_t> order_;  // objects that cache light, by group
    std::vector<RadiositySolver::Member> members_;
    AheadThread ahead_;  // last member, so that it ends first

    void prepare(const SolveKey& key);
    void prepare_links(const SolveKey& key);
    bool is_regrouped(const SolveKey& key, std::size_t member) const;
    void prepare_group(const SolveKey& key, std::size_t term, std::span<const std::size_t> group,
                       bool regrouped);
    void adopt();
};

}  // namespace hilcam
