# SPDX-License-Identifier: Apache-2.0
# Checks for what RTL must not contain: latches, memories that would become flip-flops, undriven nets, multiple drivers.
yosys proc
select -assert-none t:\$dlatch t:\$dlatchsr t:\$adlatch t:\$sr
select -assert-none t:\$mem t:\$mem_v2 t:\$memrd* t:\$memwr* t:\$meminit*
check -assert
