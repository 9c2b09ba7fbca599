local fx = effect { name = "a" }
os.execute("a")
