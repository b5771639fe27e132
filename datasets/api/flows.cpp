#include "adamas/flows.h"

#include <algorithm>

#include "core/data/multi_material_data.h"
#include "datasets/flow/impact.h"
#include "datasets/flow/mixing.h"
#include "datasets/flow/mixing_samples.h"

namespace adamas {

using namespace datasets;

namespace {

template <std::size_t N>
FlowTotals totals(const FlowLedger<N>& ledger) {
  return {{ledger.mass.begin(), ledger.mass.end()}, ledger.energy};
}

template <std::size_t N>
FlowState state_of(const FlowSolver<N>& flow, const FlowLedger<N>& start) {
  FlowState state{flow.time(),   flow.steps(),          flow.first_order_cells(), {},
                  totals(start), totals(flow.inside()), totals(flow.entered())};
  for (const FlowMaterial& material : flow.problem().materials) state.materials.push_back(material.name);
  return state;
}

}  // namespace

struct ImpactSimulation::Contents {
  FlowSolver<3> flow;
  FlowLedger<3> start = flow.inside();
};

ImpactSimulation::ImpactSimulation(const ImpactOptions& options)
    : contents_(new Contents{make_impact(options)}) {}
ImpactSimulation::ImpactSimulation(ImpactSimulation&&) noexcept = default;
ImpactSimulation& ImpactSimulation::operator=(ImpactSimulation&&) noexcept = default;
ImpactSimulation::~ImpactSimulation() = default;

void ImpactSimulation::advance_to(double time, Progress& progress) {
  contents_->flow.advance_to(time, progress);
}

FlowState ImpactSimulation::state() const { return state_of(contents_->flow, contents_->start); }

OwnedGridData ImpactSimulation::data() const {
  return OwnedGridData(
      std::make_unique<MultiMaterialData>(flow_data(contents_->flow, "impact", kImpactUnits)));
}

struct MixingSimulation::Contents {
  MixingFlow flow;
  MixingSamples samples;
  FlowLedger<2> start = flow.solver().inside();
};

MixingSimulation::MixingSimulation(const MixingOptions& options, SampleType type)
    : contents_(new Contents{MixingFlow(options), MixingSamples(options.cells, options.mach, type)}) {}
MixingSimulation::MixingSimulation(MixingSimulation&&) noexcept = default;
MixingSimulation& MixingSimulation::operator=(MixingSimulation&&) noexcept = default;
MixingSimulation::~MixingSimulation() = default;

void MixingSimulation::advance_to(double time, Progress& progress) {
  contents_->flow.advance_to(time, progress);
  contents_->samples.update(contents_->flow.solver());
}

FlowState MixingSimulation::state() const { return state_of(contents_->flow.solver(), contents_->start); }

const VolumeGrid& MixingSimulation::grid() const { return contents_->samples.grid(); }

std::vector<SampledField> MixingSimulation::fields() const {
  std::vector<SampledField> result;
  for (const MixingField& field : contents_->samples.fields())
    result.push_back({field.name, field.unit, field.scale.slope(), field.scale.intercept(), field.least,
                      field.greatest, field.cut_off, field.samples});
  return result;
}

}  // namespace adamas
