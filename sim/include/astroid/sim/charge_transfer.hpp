// Charge transfer inefficiency: what packets leave behind on their way to the register, and where it comes out.
#pragma once

#include <cstddef>
#include <vector>

#include "astroid/core/units.hpp"

namespace astroid {

/// Packets of charge that move one behind the other: the rows of some columns on their way to the register, or the
/// columns of some rows on their way along it. Each packet stands for `width` pixels side by side, which never mix.
struct TransferChain {
  std::vector<double*> packets;  ///< e-, the one that is read first, first; `width` values each
  std::size_t width = 0;
  int first_transfers = 1;  ///< transfers of the first packet; each one behind it makes one more
};

/// How many packets behind its own the charge of a packet is spread over: all but 1e-16 of it.
/// @param loss  share that one transfer leaves behind, 0 .. 1: 1 - charge transfer efficiency (CTE).
int trail_length(double loss, int transfers);

/// Moves packets that lose the same share e at every transfer, whatever they hold: a constant CTE of 1 - e.
///
/// After N transfers a packet keeps (1-e)^N of its charge, and C(N+k-1, k) e^k (1-e)^N arrives k packets later. A loss
/// of 0 leaves the bits alone; with a loss of 1 nothing ever arrives.
/// @param loss  e, 0 .. 1.
/// @returns   electrons that come out behind the last packet. Before = after + returned.
/// @accuracy  weights relative 1e-12 (test: ChargeTransfer.KeepsAndDefersAsTheBinomialSays); charge relative 1e-12.
/// A packet's result depends on the trail_length() packets before it only, so a part of a chain that begins that far
/// ahead has the same bits.
/// @complexity O(pixels x trail length), 4 packets behind 4510 transfers of loss 1e-6  @rng none  @thread safe
/// @source Janesick2001 (F36).
double transfer(const TransferChain& chain, double loss);

/// One kind of lattice defect that holds electrons back.
struct TrapSpecies {
  double density = 0.0;        ///< traps per pixel
  double cross_section = 0.0;  ///< for the capture of an electron, m²
  Seconds release;             ///< mean time to release one
};

/// The traps that packets pass.
struct TrapModel {
  std::vector<TrapSpecies> species;
  double volume_power = 0.37;  ///< beta: the volume of a packet grows as its charge to this power
  double temperature = 203.0;  ///< K
  double pixel_pitch = 18.0;   ///< µm
  Electrons full_well{900000.0};
  Seconds dwell{1e-3};  ///< time that a packet stays in one place
};

/// Moves packets through traps that fill and empty as packets pass: losses depend on the charge and on what went
/// before.
///
/// All traps between a packet and the register count at once (Short et al. 2013), so the cost is O(pixels x species).
/// Every chain begins with empty traps.
/// @returns  electrons that stay in traps behind the last packet. Before = after + returned, relative 1e-12
///           (test: Traps.ConserveCharge).
/// @valid    charge >= 0; a packet's result depends on all packets before it.
/// @complexity  O(pixels x species) (bench: BM_Traps)  @rng none  @thread safe
/// @source Short2013, Eqs. 22 and 23; Jannsen2024 for gamma = 2 N density / (FW^beta (1 + beta)) and the volume of half
/// a pixel 1 µm deep.
double transfer_through_traps(const TransferChain& chain, const TrapModel& model);

}  // namespace astroid
