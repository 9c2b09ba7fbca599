local function f(n) return n == 0 and error("deep") or f(n - 1) + 1 end
f(150)
