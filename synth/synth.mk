# SPDX-License-Identifier: Apache-2.0
# make synth           area, timing and power of every configuration in configurations.toml, into reports/
#                      LIBERTY=<typical.lib> LIBERTY_SLOW=<slow.lib>   other standard cells (table only)
#                      CONFIGURATIONS="sifh fifh"                      some configurations (table only)
#                      STRICT=1                                        fail if a goal is missed, a slack is negative or a figure is not its budget
# make synth-check     the generated library against Nangate 45 (../shared/pdk) and Debian's OSU 0.18 um; IHP 130 nm with
#                      its own SRAM macros (../shared/pdk)
# make synth-budgets   proposes new budgets (synth/budgets.csv)
# make synth-estimate  fits the models of area and power of `dtof design` to what lies in reports/ (seconds)
#                      POINTS=1                                        measures the models' own points first (half an hour)
# make synth-sizes     writes the list of SRAM sizes in use (synth/sram_sizes.csv)
# make synth-flat      the slack with every column real beside that with stand-ins; CONFIGURATIONS= as above
# make synth-corners   the slack if gates and SRAMs are slowed by one ratio; CONFIGURATIONS= as above
# make synth-test      the flow's own tests, and the porting example simulated
# make sim-icarus      RTL of every configuration, small, in Icarus Verilog against the model
# make sim-netlist     netlist of every configuration, small, beside its RTL; LIBERTY= and LIBERTY_SLOW= as above
#                      CONFIGURATIONS="sifh fifh" SEED=2               some configurations, other random frames
# make sim-netlist-full  netlists of 200 columns (ezPointer, hisPointer, poolPointer) in Verilator against the model
# make power           power from the activity of netlists on a scene: reports/power.md (minutes)
.PHONY: synth power synth-growth synth-scale synth-estimate synth-subsystem synth-flat synth-corners synth-namings synth-versions synth-check synth-budgets synth-sizes synth-test sim-icarus sim-netlist sim-netlist-full vectors

synth:
	@synth/synth.py run $(CONFIGURATIONS) $(if $(LIBERTY),--liberty $(LIBERTY)) \
	  $(if $(LIBERTY_SLOW),--liberty-slow $(LIBERTY_SLOW)) $(if $(STRICT),--strict)

synth-check:
	@scripts/install_packages.sh osu018
	@synth/synth.py check

synth-budgets synth-sizes: synth-%:
	@synth/synth.py $*

synth-flat synth-corners synth-namings: synth-%:
	@synth/synth.py $* $(CONFIGURATIONS)

synth-subsystem: vectors
	@synth/around_array.py $(CONFIGURATIONS) $(if $(STRICT),--strict)

# The other checkout is by default that of the other Debian (scripts/try_debian.sh trixie --run "make synth").
OTHER ?= build/debian/trixie/srv/dtof-readout

synth-versions:
	@synth/synth.py versions $(OTHER)

synth-growth:
	@scripts/reports.py begin growth
	@synth/synth.py growth
	@scripts/growth_plot.py
	@scripts/reports.py record growth

synth-scale: configure
	@scripts/reports.py begin scale
	@ninja -C $(BUILD) dtof > $(BUILD).log || { cat $(BUILD).log; exit 1; }
	@synth/scale.py
	@scripts/reports.py record scale

synth-estimate: $(if $(POINTS),vectors)
	@scripts/reports.py begin estimate
	@synth/synth.py estimate $(if $(POINTS),--points) $(if $(SMALL),--out $(WRITTEN_ROOT))
	@scripts/reports.py record estimate

synth-test: vectors
	@cd synth && /usr/bin/python3 -m unittest discover -q -s tests -t .

# The program that writes what the benches in synth/simulation drive and expect.
vectors: configure
	@ninja -C $(BUILD) dtof-vectors > $(BUILD).log || { cat $(BUILD).log; exit 1; }

sim-icarus: vectors
	@synth/synth.py sim-icarus --seed $(SEED) $(CONFIGURATIONS)

sim-netlist sim-netlist-full: vectors
	@synth/synth.py $@ --seed $(SEED) $(CONFIGURATIONS) $(if $(LIBERTY),--liberty $(LIBERTY)) \
	  $(if $(LIBERTY_SLOW),--liberty-slow $(LIBERTY_SLOW))

power: vectors
	@synth/synth.py $@ --seed $(SEED) $(CONFIGURATIONS)
