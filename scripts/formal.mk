# SPDX-License-Identifier: Apache-2.0
# make formal         proofs of formal/proofs.toml, each with planted bugs (25 minutes on two cores)
#                     QUICK=1              the short ones, each with its first planted bug, for CI
#                     PROOFS="minimum ..." some proofs (no report)
.PHONY: formal
formal:
	@$(if $(QUICK)$(PROOFS),,scripts/reports.py begin formal)
	@scripts/formal.py $(if $(QUICK),--quick) $(PROOFS)
	@$(if $(QUICK)$(PROOFS),,scripts/reports.py record formal)
