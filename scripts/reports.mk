# SPDX-License-Identifier: Apache-2.0
# make figures      writes measured figures into README.md and docs/, and what is stale into the first lines of reports/*.md
# make stale        lists the reports whose inputs changed since they were measured, what changed, the minutes that renewing takes
# make stale-check  fails if README.md or the page of results shows a stale figure, or a report that takes two minutes is stale (CI)
# make reports      renews every stale report in order (hours); stopped and started again it goes on where it was
# make confirm      small runs, or digests of netlists and stimuli: reports whose inputs changed are confirmed if they are the same bytes as
#                   before; NAMES="..." (docs/reference/figures.md)
# make pages        writes the pages of studies again, after the words of a page template changed; measures nothing
.PHONY: figures stale stale-check reports confirm pages
figures:
	@scripts/reports.py figures

stale stale-check:
	@scripts/reports.py $@

reports:
	@scripts/reports.py renew

confirm:
	@scripts/reports.py confirm $(NAMES)

pages: study-program
	@scripts/pages.py $(DTOF_STUDY)
