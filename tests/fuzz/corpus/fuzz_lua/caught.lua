local fx = effect { name = "a" }
while true do pcall(string.rep, "a", 1 << 23) pcall(function() while true do end end) end
