# SPDX-License-Identifier: Apache-2.0
.PHONY: products
products: configure
	@scripts/reports.py begin products
	@ninja -C $(BUILD) dtof > $(BUILD).log || { cat $(BUILD).log; exit 1; }
	@scripts/products.py
	@scripts/reports.py record products
